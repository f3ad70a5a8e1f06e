#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What single effects cost at 1920x1080, as a Markdown table: time over that of a pass that copies, by `bench`, on two pictures.

    tools/costs.py PROGRAM [EFFECT ...] [--repeat 7] [--size 1920x1080] [--picture FILE]

Each effect runs alone, with the settings of docs/effects/NAME.lua. Effects that need what the picture lacks (motion) are measured as far as they run;
a cost below 0.05 means that nothing ran.
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


def entry(name):
    """The effect's own line in its example."""
    with open(os.path.join(HERE, f"docs/effects/{name}.lua"), encoding="utf-8") as file:
        return re.search(rf"^  (fx\.{name} .*),$", file.read(), re.M)[1]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("effects", nargs="*")
    parser.add_argument("--repeat", default="7")
    parser.add_argument("--size", default="1920x1080")
    parser.add_argument("--picture", default=os.path.join(HERE, "tests/images/showcase/alley.exr"))
    arguments = parser.parse_args()
    names = arguments.effects or sorted(os.path.basename(f)[:-4] for f in glob.glob(os.path.join(HERE, "scripts/effects/*.lua")))
    with tempfile.TemporaryDirectory() as folder:
        looks = []
        for name in names:
            looks.append(os.path.join(folder, name + ".lua"))
            with open(looks[-1], "w", encoding="utf-8") as file:
                file.write(f'local fx = require "afterglow"\nreturn fx.stack {{ name = "{name}", {entry(name)} }}\n')
        subprocess.run([arguments.program, "bench", *looks, "--path", os.path.join(HERE, "docs/effects"), "--sizes", arguments.size, "--variants", "chosen",
                        "--repeat", arguments.repeat, "--picture", arguments.picture, "-o", folder], check=True, stdout=subprocess.DEVNULL)
        with open(os.path.join(folder, "bench.json"), encoding="utf-8") as file:
            cells = json.load(file)["cells"]
    costs = {cell["preset"]: cell["points"][0]["execute"]["median"] / cell["copy"]["median"] for cell in cells}
    print("| effect | copy passes |\n|---|---|")
    for name, cost in sorted(costs.items(), key=lambda item: -item[1]):
        print(f"| `{name}` | {cost:.1f} |")


if __name__ == "__main__":
    sys.exit(main())
