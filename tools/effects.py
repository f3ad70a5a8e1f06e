#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What each effect costs, how near its previews are, and what becomes of soft edges: one document, made by the program alone.

    tools/effects.py PROGRAM [EFFECT ...] [-o docs/benchmarks/effects.md] [--repeat 7] [--rounds 2]

It needs Python's own library and nothing else. Takes some minutes; costs mean something on a machine that does nothing besides.
"""
import argparse
import array
import json
import os
import struct
import subprocess
import sys
import tempfile

import costs

WHOLE, PREVIEW = "1920x1080", "33.3333%"
# Another pattern at another size, or made of the frames before.
GRAIN = {"film_grain", "glitch", "firefly_stabilisation"}
RAMP = (96, 64)  # pixels of the picture with soft edges

HEAD = """# Effects in numbers

Made by `tools/effects.py PROGRAM -o docs/benchmarks/effects.md`, which needs the program alone. {device}. Each effect runs by itself, with the settings
of [effects.md](../effects.md).

- **Cost**: time of a steady frame at 1920×1080 over that of a pass that copies the picture, on the alley at night (motion blur and taa: on the frame with
  motion vectors); {rounds}. Below 0.05 nothing ran.
- **Preview**: RMS between a run at a third of the size (`run --size`) and the whole result scaled down, both behind a tone curve, over that of the curve alone on that
  picture ({alone:.4f} on the alley): 1 is as near as a picture that is scaled first can come. Grain and glitches are another pattern at another size.
- **Alpha**: a picture with alpha from 1/64 to 1 goes through. *kept*: alpha comes out bit for bit. *colour*: for effects that work on each pixel by itself,
  the largest relative difference |x − y| / (|y| + 0.01) between colour ÷ alpha and the result of the same picture when it is opaque; effects that read
  around a pixel weigh its neighbours by their alpha, as they should, and have no such number. [alpha.md](../alpha.md) tries more settings.

| effect | copy passes | preview | alpha | colour |
|---|---|---|---|---|
"""


def run(program, look, picture, output, *more):
    subprocess.run([program, "run", look, picture, "-q", "--path", os.path.join(costs.HERE, "docs/effects"), "--type", "float", "--compression", "none",
                    "-o", output, *more], check=True)


def write_exr(path, width, height, planes):
    """An uncompressed EXR of full floats; planes by name."""
    def attribute(name, kind, data):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data
    names = sorted(planes)
    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    head = struct.pack("<ii", 20000630, 2)
    head += attribute("channels", "chlist", b"".join(n.encode() + b"\0" + struct.pack("<iB3xii", 2, 0, 1, 1) for n in names) + b"\0")
    head += attribute("compression", "compression", b"\0") + attribute("dataWindow", "box2i", box) + attribute("displayWindow", "box2i", box)
    head += attribute("lineOrder", "lineOrder", b"\0") + attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    head += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)) + attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0"
    line = 8 + 4 * width * len(names)
    with open(path, "wb") as file:
        file.write(head + b"".join(struct.pack("<Q", len(head) + 8 * height + y * line) for y in range(height)))
        for y in range(height):
            file.write(struct.pack("<ii", y, line - 8))
            for name in names:
                file.write(array.array("f", planes[name][y * width:(y + 1) * width]).tobytes())


def read_exr(path):
    """Planes of an uncompressed EXR of full floats, by name."""
    with open(path, "rb") as file:
        data = file.read()
    at, attributes = 8, {}
    while data[at]:
        name, kind = data.index(b"\0", at), 0
        kind = data.index(b"\0", name + 1)
        size = struct.unpack_from("<i", data, kind + 1)[0]
        attributes[data[at:name].decode()] = data[kind + 5:kind + 5 + size]
        at = kind + 5 + size
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height, names, listed = right - left + 1, bottom - top + 1, [], attributes["channels"]
    while listed[0]:
        end = listed.index(b"\0")
        names.append(listed[:end].decode())
        listed = listed[end + 17:]
    planes = {name: array.array("f") for name in names}
    for y in range(height):
        start = struct.unpack_from("<Q", data, at + 1 + 8 * y)[0] + 8
        for i, name in enumerate(names):
            planes[name].frombytes(data[start + 4 * width * i:start + 4 * width * (i + 1)])
    return planes


def rms(one, other):
    a, b = read_exr(one), read_exr(other)
    total = sum((x - y) * (x - y) for name in "RGB" for x, y in zip(a[name], b[name]))
    return (total / (3 * len(a["R"]))) ** 0.5


def preview(program, look, picture, nothing, folder):
    """RMS of a small run against the whole one, scaled down by the program's own mean over areas."""
    whole, small, quick = (os.path.join(folder, kind + ".exr") for kind in ("whole", "small", "quick"))
    run(program, look, picture, whole)
    run(program, nothing, whole, small, "--size", PREVIEW)
    run(program, look, picture, quick, "--size", PREVIEW)
    return rms(small, quick)


def ramp(folder):
    """The same straight colours opaque and with soft alpha: files, and that alpha."""
    width, height = RAMP
    alpha = [max(1, 64 * (x + 1) // width) / 64 for _ in range(height) for x in range(width)]
    levels = [2 ** (14 * y / (height - 1) - 7) for y in range(height)]
    colour = {name: [levels[y] * (0.25 + 0.75 * ((x * (i + 3)) % 17) / 17) for y in range(height) for x in range(width)] for i, name in enumerate("RGB")}
    opaque, soft = os.path.join(folder, "opaque.exr"), os.path.join(folder, "soft.exr")
    more = {"Z": [5.0] * len(alpha), "normal.X": [0.0] * len(alpha), "normal.Y": [0.0] * len(alpha), "normal.Z": [1.0] * len(alpha)}
    write_exr(opaque, width, height, {**colour, "A": [1.0] * len(alpha), **more})
    write_exr(soft, width, height, {**{n: [c * a for c, a in zip(plane, alpha)] for n, plane in colour.items()}, "A": alpha, **more})
    return opaque, soft


def soft_edges(program, look, opaque, soft, folder, by_pixel):
    """Whether alpha is kept, and the largest relative difference of straight colour."""
    hard_out, soft_out = os.path.join(folder, "hard_out.exr"), os.path.join(folder, "soft_out.exr")
    run(program, look, opaque, hard_out)
    run(program, look, soft, soft_out)
    a, b, given = read_exr(hard_out), read_exr(soft_out), read_exr(soft)["A"]
    kept = "A" in b and b["A"] == given
    if not by_pixel:
        return kept, None
    return kept, max(abs(x / alpha - y) / (abs(y) + 0.01) for name in "RGB" for x, alpha, y in zip(b[name], given, a[name]))


def works_by_pixel(program, look):
    """Whether all that runs of the look are pixel passes."""
    text = subprocess.run([program, "graph", look, "--path", os.path.join(costs.HERE, "docs/effects"), "--format", "json", "-q"], check=True,
                          capture_output=True, text=True).stdout
    return all(one["kind"] == "pixel" for one in json.loads(text)["graph"]["passes"])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("effects", nargs="*")
    parser.add_argument("-o", "--output")
    parser.add_argument("--repeat", default="7")
    parser.add_argument("--rounds", type=int, default=2)
    a = parser.parse_args()
    names = a.effects or costs.effects()
    rounds = [costs.measure(a.program, names, WHOLE, a.repeat) for _ in range(a.rounds)]
    device = json.loads(subprocess.run([a.program, "devices", "--json", "-q"], check=True, capture_output=True, text=True).stdout)
    with tempfile.TemporaryDirectory() as folder:
        def look_of(name, entries):
            path = os.path.join(folder, name + ".lua")
            with open(path, "w", encoding="utf-8") as file:
                file.write(f'local fx = require "afterglow"\nreturn fx.stack {{ {entries} }}\n')
            return path
        nothing = look_of("nothing", "")
        opaque, soft = ramp(folder)
        example = lambda name: os.path.join(costs.HERE, f"docs/effects/{name}.lua")
        alone = {}
        rows = []
        for name in names:
            picture = costs.picture_of(name, costs.PICTURE)
            if picture not in alone:
                alone[picture] = preview(a.program, example("before"), picture, nothing, folder)
            near = preview(a.program, example(name), picture, nothing, folder) / alone[picture]
            by_itself = look_of(name, costs.entry(name))
            kept, colour = soft_edges(a.program, by_itself, opaque, soft, folder, works_by_pixel(a.program, by_itself))
            least, most = min(r[name] for r in rounds), max(r[name] for r in rounds)
            cost = f"{least:.1f}" if f"{least:.1f}" == f"{most:.1f}" else f"{least:.1f} to {most:.1f}"
            rows.append(f"| `{name}` | {cost} | {'grain' if name in GRAIN else f'{near:.2f}'} | "
                        f"{'kept' if kept else 'changed'} | {'' if colour is None else f'{colour:.0e}'} |\n")
            print(rows[-1], end="", file=sys.stderr, flush=True)
    text = HEAD.format(device=f"{device[0]['name']}, {device[0]['driver']}", rounds="one round" if a.rounds == 1 else f"smallest and largest of {a.rounds} rounds", alone=alone.get(costs.PICTURE, 0)) + "".join(rows)
    if a.output:
        with open(a.output, "w", encoding="utf-8") as file:
            file.write(text)
    else:
        print(text, end="")


if __name__ == "__main__":
    sys.exit(main())
