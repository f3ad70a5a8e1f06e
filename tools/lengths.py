#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How well `reference_height` holds lengths at every resolution: one scene at several heights, as a Markdown table.

    tools/lengths.py PROGRAM [--heights 540 1080 2160 4320] [--effects NAME ...]

The scene is a bright disc with a soft edge, and its depth with a hard one. Each effect runs with lengths of 1080 lines. Two figures, both relative to those at 1080 lines:
  reach   sqrt(sum |d| r^2 / sum |d|) / height, where d is what the effect changed and r the distance from the disc's edge
  amount  sum |d| / height^2
Needs numpy and oiiotool. Exit code 1 when the reach of an effect with lengths is more than 2 % off.
"""
import argparse
import os
import subprocess
import sys
import tempfile

import numpy

LOOKS = {
    "anamorphic_streaks": "threshold = 1",
    "bloom": 'mode = "scattering", intensity = 0.3',
    "bloom additive": "intensity = 0.5",
    "bokeh_blur": "radius = 14",
    "box_bloom": "",
    "depth_of_field": "focus_distance = 2, aperture = 1.4, max_radius = 14, samples = 256",
    "directional_blur": "distance = 60",
    "directional_blur short": "distance = 12",
    "dual_kawase": "iterations = 4",
    "edge_detection": "intensity = 1",  # has no length but the pixel
    "outline": 'source = "depth", width = 6',
    "pixelate": "size = 24",
}
RADIUS, SOFT = 0.11, 0.02  # of the height


def scene(folder, height):
    """A disc of brightness 8 before a ground of 0.05, as R,G,B,A,Z,NX,NY,NZ."""
    y, x = numpy.mgrid[0:height, 0:height] + 0.5
    away = numpy.hypot(x - height / 2, y - height / 2)
    # A soft edge, so that the pixels of any height show the same disc.
    t = numpy.clip((RADIUS * height - away) / (SOFT * height) + 0.5, 0, 1)
    disc = (t * t * (3 - 2 * t)).astype(numpy.float32)
    color = 0.05 + 7.95 * disc
    front = away < RADIUS * height
    plane = numpy.where(front, 5, 20).astype(numpy.float32)
    names = []
    for name, image in (("color", color), ("depth", plane)):
        with open(f"{folder}/{name}.pfm", "wb") as file:
            file.write(f"Pf\n{height} {height}\n-1\n".encode())
            file.write(image[::-1].tobytes())
        names.append(f"{folder}/{name}.pfm")
    out = f"{folder}/scene.exr"
    subprocess.run(["oiiotool", names[0], "--ch", "0,0,0", "--chnames", "R,G,B", names[1], "--chnames", "Z", "--chappend",
                    "-d", "float", "--compression", "none", "-o", out], check=True)
    return out, color, (away - RADIUS * height) / height


def green(exr, height):
    """The green of an uncompressed EXR of floats: its lines stand at the end of the file, each behind its number and size, channels by name."""
    data = open(exr, "rb").read()
    for channels in (3, 4):
        line = 8 + 4 * channels * height
        first = numpy.frombuffer(data, numpy.int32, 2, len(data) - line * height)
        if first[1] == line - 8:
            lines = numpy.frombuffer(data, numpy.float32, offset=len(data) - line * height).reshape(height, line // 4)
            return lines[:, 2:].reshape(height, channels, height)[:, channels - 2]
    raise SystemExit(f"{exr} is not as expected")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--heights", type=int, nargs="*", default=[540, 1080, 2160, 4320])
    parser.add_argument("--effects", nargs="*")
    a = parser.parse_args()
    names = [name for name in LOOKS if not a.effects or name.split()[0] in a.effects]
    figures = {name: {} for name in names}
    with tempfile.TemporaryDirectory() as folder:
        for height in a.heights:
            exr, source, away = scene(folder, height)
            for name in names:
                look = f"{folder}/look.lua"
                with open(look, "w") as file:
                    file.write('local fx = require "afterglow"\nreturn fx.stack { reference_height = 1080, fx.%s { %s } }\n' %
                               (name.split()[0], LOOKS[name]))
                subprocess.run([a.program, "run", look, exr, "-q", "--reference", "--type", "float", "--compression", "none", "--max-memory", "20G", "-o",
                                f"{folder}/out.exr"], check=True)
                change = numpy.abs(green(f"{folder}/out.exr", height).astype(float) - source)
                total = change.sum()
                figures[name][height] = (numpy.sqrt((change * away**2).sum() / total) if total else 0, total / height**2)
    print("| effect | " + " | ".join(f"{h} reach | amount" for h in a.heights) + " |\n|---|" + "---|---|" * len(a.heights))
    bad = []
    for name in names:
        middle = figures[name].get(1080) or figures[name][a.heights[0]]
        cells = []
        for height in a.heights:
            reach, amount = (v / m if m else float(v == m) for v, m in zip(figures[name][height], middle))
            cells.append(f"{reach:.3f} | {amount:.3f}")
            if abs(reach - 1) > 0.02 and name != "edge_detection":
                bad.append(f"{name} at {height}")
        print(f"| {name} | " + " | ".join(cells) + " |", flush=True)
    if bad:
        print("\nMore than 2 % off: " + ", ".join(bad))
    return 1 if bad else 0


sys.exit(main())
