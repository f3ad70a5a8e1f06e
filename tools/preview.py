#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How well previews show each effect: RMS between `run --size` and the whole result scaled down, as a Markdown table.

    tools/preview.py PROGRAM PICTURE [--size 320x180] [--effects NAME ...]

Each effect runs with the settings of docs/effects/NAME.lua, whose stack ends with an exposure and a tone curve; the last column is that RMS over the
one of these alone. Needs oiiotool. Exit code 1 when an effect that is not like grain is above 1.2.
"""
import argparse
import glob
import os
import re
import subprocess
import sys
import tempfile

GRAIN = {"film_grain", "glitch", "firefly_stabilisation"}  # another pattern at another size, or made of frames before


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("picture")
    parser.add_argument("--size", default="320x180")
    parser.add_argument("--effects", nargs="*")
    parser.add_argument("--keep")
    a = parser.parse_args()
    root = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
    folder = a.keep or tempfile.mkdtemp()
    os.makedirs(folder, exist_ok=True)

    def difference(preset, name):
        whole, small, preview = (f"{folder}/{name}.{kind}.exr" for kind in ("whole", "small", "preview"))
        run = [a.program, "run", preset, a.picture, "-q", "--type", "float", "--compression", "none"]
        subprocess.run([*run, "-o", whole], check=True)
        subprocess.run([*run, "-o", preview, "--size", a.size], check=True)
        subprocess.run(["oiiotool", whole, "--ch", "R,G,B", "--resize:filter=box", a.size, "-o", small], check=True)
        text = subprocess.run(["oiiotool", preview, "--ch", "R,G,B", small, "--diff"], capture_output=True, text=True).stdout
        os.remove(whole)
        return float(re.search(r"RMS error = ([0-9.e+-]+)", text)[1])

    alone, bad = difference(f"{root}/docs/effects/before.lua", "before"), []
    print(f"| effect | RMS | over the curve alone ({alone:.4f}) |\n|---|---|---|")
    for preset in sorted(glob.glob(f"{root}/docs/effects/*.lua")):
        name = os.path.basename(preset)[:-4]
        if name in ("before", "tone_mapping", "lut") or a.effects and name not in a.effects:
            continue
        rms = difference(preset, name)
        print(f"| {name}{' (like grain)' if name in GRAIN else ''} | {rms:.4f} | {rms / alone:.2f} |", flush=True)
        if rms > 1.2 * alone and name not in GRAIN:
            bad.append(name)
    if bad:
        print("\nAbove 1.2: " + ", ".join(bad))
    return 1 if bad else 0


sys.exit(main())
