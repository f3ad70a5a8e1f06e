#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How much of a picture each preset clips, beside its tone curve alone: shares of pixels with a channel at 255, as a Markdown table.

    tools/clipping.py PROGRAM PICTURE ... [--presets FILE ...] [--size 960] [--keep FOLDER] [--sheet FILE] [--limit 5]

Exit code 1 when a preset clips more than LIMIT points above its tone curve. --keep saves the pictures, --sheet puts them all on one: a row for
each preset, a column for each picture. Needs oiiotool, and ImageMagick for the sheet.
"""
import argparse
import glob
import json
import os
import re
import subprocess
import sys
import tempfile


def clipped(picture):
    """Share of pixels with a channel at the highest code, in percent."""
    text = subprocess.run(["oiiotool", picture, "--ch", "0,1,2", "--rangecheck", "-1,-1,-1", "0.998,0.998,0.998"], capture_output=True,
                          text=True, check=True).stdout
    below, above, within = (int(re.search(rf"^\s*(\d+)\s+{word}", text, re.M)[1]) for word in ("<", ">", "within"))
    return 100 * above / (below + above + within)


def contact_sheet(rows, out):
    """A row of pictures for each (name, pictures), with the name above it."""
    command = ["montage"]
    for name, pictures in rows:
        for column, picture in enumerate(pictures):
            command += ["-label", name if column == 0 else " ", picture]
    subprocess.run([*command, "-geometry", "320x192+3+2", "-tile", f"{len(rows[0][1])}x", "-background", "#303030", "-fill", "white",
                    "-pointsize", "15", "-quality", "84", "-sampling-factor", "4:2:0", out], check=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("pictures", nargs="+")
    parser.add_argument("--presets", nargs="*")
    parser.add_argument("--size")
    parser.add_argument("--keep")
    parser.add_argument("--sheet")
    parser.add_argument("--limit", type=float, default=5)
    a = parser.parse_args()
    root = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
    presets = a.presets or sorted(glob.glob(f"{root}/presets/*.lua") + glob.glob(f"{root}/presets/*/*.lua"))
    folder = a.keep or tempfile.mkdtemp()
    os.makedirs(folder, exist_ok=True)

    def render(preset, picture, name, *options):
        out = f"{folder}/{name}.png"
        size = ["--size", a.size] if a.size else []
        subprocess.run([a.program, "run", preset, picture, "-o", out, "-q", *size, *options], check=True)
        return clipped(out)

    names = [os.path.basename(picture).split(".")[0] for picture in a.pictures]
    plain = f"{folder}/curve.lua"
    with open(plain, "w") as file:
        file.write('local fx = require "afterglow"\nreturn fx.stack { fx.tone_mapping {} }\n')
    alone, worst, rows = {}, 0, []
    print("| preset | curve | " + " | ".join(names) + " |\n|---|---|" + "---|" * len(names))
    for preset in presets:
        check = json.loads(subprocess.run([a.program, "check", preset, "--json"], capture_output=True, text=True, check=True).stdout)
        curve = next((e["settings"]["mode"] for e in check["entries"] if e["effect"] == "tone_mapping"), "none")
        cells = []
        rows.append((os.path.basename(preset)[:-4], []))
        for picture, name in zip(a.pictures, names):
            if (curve, name) not in alone:
                alone[curve, name] = render(plain, picture, f"{name}.{curve}", "--set", f"tone_mapping.mode={curve}")
            share = render(preset, picture, f"{name}.{rows[-1][0]}")
            rows[-1][1].append(f"{folder}/{name}.{rows[-1][0]}.png")
            worst = max(worst, share - alone[curve, name])
            cells.append(f"{share:.2f} ({share - alone[curve, name]:+.2f})")
        print(f"| {rows[-1][0]} | {curve} | " + " | ".join(cells) + " |", flush=True)
    if a.sheet:
        contact_sheet(rows, a.sheet)
    print(f"\nWorst: {worst:+.2f} points above the curve alone.")
    return 1 if worst > a.limit else 0


sys.exit(main())
