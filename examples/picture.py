#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A look run on an array, in Python: picture.py PRESET OUTPUT.ppm"""
import sys

import numpy as np

import afterglow


def main(preset, output):
    picture = np.full((180, 320, 3), 0.02, np.float32)
    picture[70:110, 140:180] = (20, 6, 2)

    stack = afterglow.Stack(preset)
    for entry in stack.settings:
        print(entry["name"], {setting["name"]: setting["value"] for setting in entry["settings"]})

    graded = stack.run(picture, dtype=np.uint8)

    with open(output, "wb") as file:
        file.write(b"P6\n%d %d\n255\n" % (graded.shape[1], graded.shape[0]))
        file.write(graded.tobytes())


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    try:
        main(*sys.argv[1:])
    except afterglow.Error as error:
        sys.exit(str(error))  # file, line, what is wrong, what is allowed
