#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What single effects cost at 1920x1080, as a Markdown table: time over that of a pass that copies, by `bench`.

    tools/costs.py PROGRAM [EFFECT ...] [--repeat 7] [--size 1920x1080] [--picture FILE] [--defaults]

Each effect runs alone, with the settings of docs/effects/NAME.lua (`--defaults`: with none). Those whose example names a picture of its own, as motion
wants, run on that. A frame is a steady one: what is made once has been made. A cost below 0.05 means that nothing ran.
"""
import argparse
import glob
import json
import os
import re
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PICTURE = os.path.join(HERE, "tests/images/showcase/alley.exr")


def example(name):
    """The text of the effect's example."""
    with open(os.path.join(HERE, f"docs/effects/{name}.lua"), encoding="utf-8") as file:
        return file.read()


def entry(name):
    """The effect's own line in its example."""
    return re.search(rf"^  (fx\.{name} .*),$", example(name), re.M)[1]


def picture_of(name, usual):
    """A frame with motion vectors for effects whose example asks for the moving alley; else the usual picture."""
    moves = re.search(r"^-- input: \S*alley_(move|shot)", example(name), re.M)
    return os.path.join(HERE, "tests/images/showcase/alley_move.exr") if moves else usual


def effects():
    """Names of all effects that come along."""
    return sorted(os.path.basename(f)[:-4] for f in glob.glob(os.path.join(HERE, "scripts/effects/*.lua")))


def measure(program, names, size="1920x1080", repeat="7", picture=PICTURE, defaults=False):
    """Copy passes by effect."""
    costs = {}
    by_picture = {}
    for name in names:
        by_picture.setdefault(picture_of(name, picture), []).append(name)
    for file, those in by_picture.items():
        with tempfile.TemporaryDirectory() as folder:
            looks = []
            for name in those:
                looks.append(os.path.join(folder, name + ".lua"))
                with open(looks[-1], "w", encoding="utf-8") as look:
                    text = f"fx.{name} {{}}" if defaults else entry(name)
                    look.write(f'local fx = require "afterglow"\nreturn fx.stack {{ name = "{name}", {text} }}\n')
            subprocess.run([program, "bench", *looks, "--path", os.path.join(HERE, "docs/effects"), "--sizes", size, "--variants", "chosen",
                            "--repeat", repeat, "--picture", file, "-o", folder], check=True, stdout=subprocess.DEVNULL)
            with open(os.path.join(folder, "bench.json"), encoding="utf-8") as out:
                for cell in json.load(out)["cells"]:
                    costs[cell["preset"]] = cell["points"][0]["execute"]["median"] / cell["copy"]["median"]
    return costs


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("effects", nargs="*")
    parser.add_argument("--repeat", default="7")
    parser.add_argument("--size", default="1920x1080")
    parser.add_argument("--picture", default=PICTURE)
    parser.add_argument("--defaults", action="store_true")
    a = parser.parse_args()
    costs = measure(a.program, a.effects or effects(), a.size, a.repeat, a.picture, a.defaults)
    print("| effect | copy passes |\n|---|---|")
    for name, cost in sorted(costs.items(), key=lambda item: -item[1]):
        print(f"| `{name}` | {cost:.1f} |")


if __name__ == "__main__":
    sys.exit(main())
