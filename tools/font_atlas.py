#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The letters of `burn_in`: makes assets/fonts/mono.exr out of a monospaced font.

    tools/font_atlas.py FONT.ttf OUT.exr      (python3-numpy, python3-pil, openimageio-tools)

Every letter has a cell of 24x48 pixels, 32 cells a row, in the order of RANGES (the same ranges stand in
scripts/lib/letters.lua). A pixel says how far its middle is from the letter's edge: 0.5 on the edge, 1 from
SPREAD pixels within, 0 from SPREAD outside, in steps of 1/256.
"""
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from PIL import Image, ImageDraw, ImageFont

RANGES = [(0x20, 0x7E), (0xA0, 0x17F), (0x384, 0x3CE), (0x400, 0x45F), (0x2010, 0x2015), (0x2018, 0x201E),
          (0x2020, 0x2022), (0x2026, 0x2026), (0x20AC, 0x20AC), (0x2122, 0x2122), (0x2190, 0x2193), (0x25A1, 0x25A1),
          (0x25CF, 0x25CF)]
WIDTH, HEIGHT, COLUMNS, SPREAD, FINER = 24, 48, 32, 6, 8


def distances(inside):
    """From each pixel's middle to the nearest one outside, in pixels; as far as SPREAD."""
    reach = SPREAD * FINER + 1
    across = np.where(inside, float(2 * reach), 0.0)
    for step in range(1, reach + 1):
        near = np.full_like(across, 2 * reach)
        near[:, step:] = np.where(inside[:, :-step], 2 * reach, step)
        across = np.minimum(across, near)
        near = np.full_like(across, 2 * reach)
        near[:, :-step] = np.where(inside[:, step:], 2 * reach, step)
        across = np.minimum(across, near)
    best = across**2
    for step in range(1, reach + 1):
        best[step:] = np.minimum(best[step:], across[:-step] ** 2 + step**2)
        best[:-step] = np.minimum(best[:-step], across[step:] ** 2 + step**2)
    return np.sqrt(best)


def cell(font, ascent, letter):
    picture = Image.new("L", (WIDTH * FINER, HEIGHT * FINER))
    ImageDraw.Draw(picture).text((0, ascent), letter, font=font, fill=255, anchor="ls")
    inside = np.asarray(picture) >= 128
    # Half a pixel: the edge lies between the last one within and the first one outside.
    signed = np.where(inside, distances(inside) - 0.5, 0.5 - distances(~inside)) / FINER
    middle = signed.reshape(HEIGHT, FINER, WIDTH, FINER)[:, FINER // 2 - 1 : FINER // 2 + 1, :, FINER // 2 - 1 : FINER // 2 + 1]
    return middle.mean(axis=(1, 3))


def main():
    name, out = sys.argv[1:]
    size = 100
    while ImageFont.truetype(name, size + 1).getlength("M") <= WIDTH * FINER:
        size += 1
    font = ImageFont.truetype(name, size)
    above, below = font.getmetrics()
    ascent = round((HEIGHT * FINER - above - below) / 2) + above
    letters = [chr(code) for first, last in RANGES for code in range(first, last + 1)]
    rows = -(-len(letters) // COLUMNS)
    atlas = np.full((rows * HEIGHT, COLUMNS * WIDTH), -float(SPREAD))
    for at, letter in enumerate(letters):
        y, x = at // COLUMNS * HEIGHT, at % COLUMNS * WIDTH
        atlas[y : y + HEIGHT, x : x + WIDTH] = cell(font, ascent, letter)
    values = np.clip(np.round((atlas / SPREAD + 1) * 128), 0, 256) / 256
    with tempfile.TemporaryDirectory() as folder:
        plain = pathlib.Path(folder) / "atlas.pfm"  # its last row comes first
        plain.write_bytes(b"Pf\n%d %d\n-1\n" % values.shape[::-1] + values[::-1].astype("<f4").tobytes())
        subprocess.run(["oiiotool", str(plain), "--nosoftwareattrib", "--chnames", "Y", "--attrib", "DateTime", "", "-d", "half",
                        "--compression", "zip", "-o", out], check=True)
    print(len(letters), "letters of size", size, values.shape[::-1])


main()
