#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes docs/tone_mapping.md and its pictures: what each mode of tone_mapping does to greys and to saturated colours, measured.

    tools/tone_page.py PROGRAM

Ramps of light go through the program itself, as EXR to be measured and as PNG to be looked at.
"""
import math
import os
import struct
import subprocess
import sys
import tempfile

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
WIDTH, STRIPE, LOW, HIGH = 640, 20, -8.0, 8.0  # pixels; stops from middle grey

COLOURS = {
    "grey": (1, 1, 1), "red": (1, 0, 0), "orange": (1, 0.35, 0.02), "yellow": (1, 1, 0), "green": (0, 1, 0), "cyan": (0, 1, 1),
    "blue": (0, 0, 1), "magenta": (1, 0, 1), "skin": (0.8, 0.45, 0.33), "sky": (0.25, 0.45, 0.9),
}
MODES = [
    ("aces", {}, "Unity's fit of the ACES RRT and sRGB ODT"), ("neutral", {}, "Unity's neutral: Hable's Uncharted 2 curve"),
    ("reinhard", {}, "Reinhard et al. 2002, eq. 3, per channel"), ("reinhard_extended", {}, "Reinhard et al. 2002, eq. 4, on luminance; white = 8"),
    ("agx", {"look": "base"}, "Sobotka 2022, Blender's matrices"), ("agx", {"look": "punchy"}, "the same, look of Wrensch"),
    ("agx", {"look": "golden"}, "the same, look of Wrensch"), ("khronos_neutral", {}, "Khronos PBR Neutral 2024"),
    ("hable", {}, "Hable 2017, piecewise powers; white = 8"), ("gt", {}, "Uchimura 2017"),
]


def luminance(c):
    return 0.2126729 * c[0] + 0.7151522 * c[1] + 0.0721750 * c[2]


def light_at(x):
    return 0.18 * 2 ** (LOW + (HIGH - LOW) * (x + 0.5) / WIDTH)


def write_ramps(file):
    """One stripe for each colour, of the luminance of the grey above it."""
    rows = []
    for colour in COLOURS.values():
        scale = 1 / luminance(colour)
        row = b"".join(struct.pack("<3f", *(c * scale * light_at(x) for c in colour)) for x in range(WIDTH))
        rows += [row] * STRIPE
    with open(file, "wb") as out:
        out.write(f"PF\n{WIDTH} {len(rows)}\n-1.0\n".encode())
        out.write(b"".join(reversed(rows)))


def read_exr(file):
    """Pixels of an uncompressed EXR of full floats with the channels B, G, R."""
    data, at = open(file, "rb").read(), 8
    window = None
    while data[at]:
        name, kind, rest = data[at:].split(b"\0", 2)
        at += len(name) + len(kind) + 2
        size = struct.unpack_from("<i", data, at)[0]
        if name == b"dataWindow":
            window = struct.unpack_from("<4i", data, at + 4)
        at += 4 + size
    width, height = window[2] + 1, window[3] + 1
    first = at + 1 + 8 * height
    line = 8 + 12 * width
    assert len(data) == first + height * line
    return lambda x, y: tuple(struct.unpack_from("<f", data, first + y * line + 8 + 4 * (width * c + x))[0] for c in (2, 1, 0))


def oklab_hue(c):
    """Hue in degrees and chroma (B. Ottosson, 2020)."""
    r, g, b = (max(v, 0) for v in c)
    l, m, s = (v ** (1 / 3) for v in (0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b,
                                      0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b,
                                      0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b))
    a = 1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s
    d = 0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s
    return math.degrees(math.atan2(d, a)), math.hypot(a, d)


def worst_turn(pixel, row, colour):
    """The largest turn of hue where the display still shows a colour; channels held to what a display has."""
    wanted, worst = oklab_hue(colour)[0], 0
    for x in range(WIDTH):
        hue, chroma = oklab_hue([min(max(v, 0), 1) for v in pixel(x, row)])
        if chroma > 0.04:
            worst = max(worst, abs((hue - wanted + 180) % 360 - 180))
    return worst


def srgb(v):
    v = min(max(v, 0), 1)
    return 12.92 * v if v <= 0.0031308 else 1.055 * v ** (1 / 2.4) - 0.055


def curves_svg(curves):
    colours = ["#d1495b", "#30638e", "#00798c", "#edae49", "#7b2d8b", "#b36ac2", "#d9a5e3", "#3c6e47", "#666666", "#1b1b1b"]
    w, h, left, top = 860, 460, 50, 20
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {w} {h}" font-family="sans-serif" font-size="12">',
           f'<rect width="{w}" height="{h}" fill="white"/>']
    plot_w, plot_h = 600, 400
    for stop in range(-8, 9, 2):
        x = left + plot_w * (stop - LOW) / (HIGH - LOW)
        out.append(f'<line x1="{x:.1f}" x2="{x:.1f}" y1="{top}" y2="{top + plot_h}" stroke="#ddd"/>'
                   f'<text x="{x:.1f}" y="{top + plot_h + 18}" text-anchor="middle">{stop:+d}</text>')
    for code in range(0, 256, 51):
        y = top + plot_h * (1 - code / 255)
        out.append(f'<line x1="{left}" x2="{left + plot_w}" y1="{y:.1f}" y2="{y:.1f}" stroke="#ddd"/>'
                   f'<text x="{left - 6}" y="{y + 4:.1f}" text-anchor="end">{code}</text>')
    out.append(f'<text x="{left + plot_w / 2}" y="{h - 6}" text-anchor="middle">stops from middle grey (0.18)</text>')
    for i, (name, values) in enumerate(curves):
        points = " ".join(f"{left + plot_w * (x + 0.5) / WIDTH:.1f},{top + plot_h * (1 - srgb(v)):.1f}" for x, v in enumerate(values) if x % 4 == 0)
        out.append(f'<polyline points="{points}" fill="none" stroke="{colours[i]}" stroke-width="2"/>'
                   f'<text x="{left + plot_w + 20}" y="{top + 20 + 22 * i}" fill="{colours[i]}">{name}</text>')
    return "\n".join(out + ["</svg>\n"])


def main():
    program, folder = sys.argv[1], tempfile.mkdtemp()
    pictures = f"{ROOT}/docs/images/tone"
    os.makedirs(pictures, exist_ok=True)
    write_ramps(f"{folder}/ramps.pfm")
    preset = f"{folder}/curve.lua"
    with open(preset, "w") as file:
        file.write('local fx = require "afterglow"\nreturn fx.stack { fx.tone_mapping {} }\n')

    def run(output, mode, settings):
        exact = ["--type", "float", "--compression", "none"] if output.endswith(".exr") else ["--dither", "none"]
        chosen = [word for pair in {"mode": mode, **settings}.items() for word in ("--set", f"tone_mapping.{pair[0]}={pair[1]}")]
        subprocess.run([program, "run", preset, f"{folder}/ramps.pfm", "-o", output, "-q", *exact, *chosen], check=True)

    run(f"{pictures}/none.png", "none", {})
    curves, greys, turns = [], [], []
    for mode, settings, source in MODES:
        name = " ".join([mode, *settings.values()])
        file = name.replace(" ", "_")
        run(f"{pictures}/{file}.png", mode, settings)
        run(f"{folder}/{file}.exr", mode, settings)
        pixel = read_exr(f"{folder}/{file}.exr")
        values = [pixel(x, STRIPE // 2)[1] for x in range(WIDTH)]
        curves.append((name, values))

        def grey(light):
            x = (math.log2(light / 0.18) - LOW) / (HIGH - LOW) * WIDTH - 0.5
            i = min(int(x), WIDTH - 2)
            return values[i] + (x - i) * (values[i + 1] - values[i])

        white = next((light_at(x) for x, v in enumerate(values) if srgb(v) >= 254.5 / 255), None)
        greys.append(f"| `{name}` | {source} | " + " | ".join(f"{255 * srgb(grey(v)):.0f}" for v in (0.0225, 0.18, 1, 4, 16)) +
                     f" | {max(values):.3f} | {f'{white:.1f}' if white else 'never'} |")
        rows = [(colour, (i + 0.5) * STRIPE) for i, colour in enumerate(COLOURS.items()) if colour[0] != "grey"]
        found = [worst_turn(pixel, int(row), colour[1]) for colour, row in rows]
        turns.append(f"| `{name}` | " + " | ".join(f"{t:.0f}" for t in found) + f" | {sum(found) / len(found):.0f} |")
    with open(f"{pictures}/curves.svg", "w") as file:
        file.write(curves_svg(curves))
    names = [name for name in COLOURS if name != "grey"]
    with open(f"{ROOT}/docs/tone_mapping.md", "w") as page:
        page.write("""# Tone curves

Made by `tools/tone_page.py` from what the program makes of ramps of light. Formulas and sources: [math.md](math.md) §6 and §21. `fx.tone_mapping { mode = "agx" }` chooses one;
`exposure` comes before it.

## Greys

![the curves](images/tone/curves.svg)

8-bit codes that a display gets for grey light of 0.0225 (three stops below middle grey) to 16; `most` is the display-linear value of the brightest light of the ramp (46), `white` the light from which on the code is
255. ACES ends at 0.945 and Reinhard at 0.984: `full_white = true` makes that 1.

| mode | source | 0.0225 | 0.18 | 1 | 4 | 16 | most | white |
|---|---|---|---|---|---|---|---|---|
""" + "\n".join(greys) + """

## Colours

Ramps of light of equal luminance, eight stops below middle grey on the left, eight above on the right: grey, """ + ", ".join(names) + """.

| | |
|---|---|
| none (values above 1 clip) | ![none](images/tone/none.png) |
""" + "\n".join(f"| `{name}` | ![{name}](images/tone/{name.replace(' ', '_')}.png) |" for name, _ in curves) + """

How far hues turn: the largest turn along a ramp, in degrees of Oklab hue, of what a display shows (channels held to 0 to 1) where it still shows colour (chroma above 0.04). Curves that work on each channel bend hues
towards the primaries and secondaries; those that bleach first bend less. None keeps hues in all light: what a display cannot show has to go somewhere.

| mode | """ + " | ".join(names) + " | mean |\n|---|" + "---|" * (len(names) + 1) + "\n" + "\n".join(turns) + "\n")


main()
