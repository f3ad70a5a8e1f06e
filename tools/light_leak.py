#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A leak of light for `image_overlay`: makes assets/overlays/light_leak.png, sRGB in 16 bits, light on black.

Needs numpy and oiiotool. Run in the root of the repository: tools/light_leak.py
"""
import subprocess
import tempfile

import numpy

WIDTH, HEIGHT = 192, 108


def srgb(linear):
    return numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * numpy.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055)


def main():
    y, x = (numpy.mgrid[0:HEIGHT, 0:WIDTH] + 0.5) / HEIGHT
    light = numpy.zeros((HEIGHT, WIDTH, 3))
    # Place and width in heights of the picture, turn, colour: light that comes through the seams of a camera's back.
    for at, wide, turn, colour in [
        ((1.82, 0.25), (0.28, 0.75), 0.25, (0.9, 0.20, 0.03)),
        ((1.76, 0.50), (0.10, 0.55), 0.15, (0.9, 0.55, 0.15)),
        ((1.55, 0.85), (0.35, 0.20), -0.5, (0.35, 0.05, 0.02)),
        ((0.00, 0.95), (0.18, 0.40), -0.3, (0.45, 0.10, 0.03)),
    ]:
        dx, dy = x - at[0], y - at[1]
        along = (numpy.cos(turn) * dx + numpy.sin(turn) * dy) / wide[0]
        across = (numpy.cos(turn) * dy - numpy.sin(turn) * dx) / wide[1]
        light += numpy.exp(-(along**2 + across**2))[..., None] * colour
    codes = srgb(numpy.clip(light - 0.002, 0, 1)).astype("<f4")
    with tempfile.NamedTemporaryFile(suffix=".pfm") as file:
        file.write(f"PF\n{WIDTH} {HEIGHT}\n-1.0\n".encode() + codes[::-1].tobytes())
        file.flush()
        subprocess.run(["oiiotool", file.name, "--iscolorspace", "sRGB", "-d", "uint16", "-o", "assets/overlays/light_leak.png"], check=True)


main()
