#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What opacity, blend modes and masks cost, in copy passes of the picture, as a Markdown table.

    tools/mask_cost.py PROGRAM [--size 1920x1080] [--repeat 25]

Each row is the time of a look whose entry is faded, blended or masked, minus that of the same look without, both as `run` executes
them, divided by the time of one RGBA32F copy pass (`afterglow bench`). Times are the quickest of all rounds: what else runs on the
machine only makes them longer. Kernels are those of `afterglow graph`:
as many as without mean that everything runs in the entry's last kernel.
"""
import argparse
import json
import os
import struct
import subprocess
import tempfile
import zlib

ENTRIES = {
    "color_adjustments": "fx.color_adjustments { contrast = 20%s }, fx.tone_mapping { mode = \"neutral\" }",
    "bloom": "fx.bloom { threshold = 1, intensity = 0.3%s }, fx.tone_mapping { mode = \"neutral\" }",
    "directional_blur": "fx.directional_blur { distance = 24%s }",
}
KEYS = {
    "as it is": "",
    "`opacity = 0.5`": ", opacity = 0.5",
    "`blend = \"screen\"`": ", blend = \"screen\"",
    "`mask = fx.mask.luma {}`": ", mask = fx.mask.luma { from = 0.2, softness = 0.3 }",
    "`mask = fx.mask.radial {}`": ", mask = fx.mask.radial { radius = { 0.3, 0.3 }, softness = 0.5 }",
    "`mask = fx.mask.luma {} * fx.mask.radial {}`": ", mask = fx.mask.luma { from = 0.2, softness = 0.3 } * fx.mask.radial { softness = 0.5 }",
    "`mask = fx.mask.file {}`": ", mask = fx.mask.file { file = \"mask.png\" }",
    "`mask = 0`": ", mask = 0",
}


def write_mask(path, width, height):
    """A gradient across, as a grey PNG."""
    row = bytes([0]) + bytes(255 * x // (width - 1) for x in range(width))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)))
        file.write(chunk(b"IDAT", zlib.compress(row * height)) + chunk(b"IEND", b""))


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("program")
    arguments.add_argument("--size", default="1920x1080")
    arguments.add_argument("--repeat", default="25")
    options = arguments.parse_args()
    program = os.path.abspath(options.program)
    with tempfile.TemporaryDirectory() as folder:
        write_mask(os.path.join(folder, "mask.png"), *map(int, options.size.split("x")))
        print("| entry | with | kernels | ms | copy passes more |\n|---|---|---|---|---|")
        for effect, text in ENTRIES.items():
            files = []
            for index, key in enumerate(KEYS.values()):
                files.append(os.path.join(folder, "%s_%d.lua" % (effect, index)))
                with open(files[-1], "w") as file:
                    file.write('local fx = require "afterglow"\nreturn fx.stack { %s }\n' % (text % key))
            subprocess.run([program, "bench", *files, "--sizes", options.size, "--variants", "chosen", "--repeat", options.repeat,
                            "-q", "-o", os.path.join(folder, "bench")], check=True, stdout=subprocess.DEVNULL)
            with open(os.path.join(folder, "bench", "bench.json")) as file:
                cells = {cell["preset"]: cell for cell in json.load(file)["cells"]}
            plain = None
            for name, path in zip(KEYS, files):
                cell = cells[os.path.splitext(os.path.basename(path))[0]]
                point = cell["points"][0]
                least = min(point["execute"]["samples"])
                if plain is None:
                    plain, copy = least, min(cell["copy"]["samples"])
                more = (least - plain) / copy
                print("| %s | %s | %d | %.2f | %s |" % (effect, name, point["kernels"], least,
                                                     "" if name == "as it is" else "%+.2f" % more))


if __name__ == "__main__":
    main()
