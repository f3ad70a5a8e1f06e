#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What two versions of the program take, in turns, as Markdown tables.

    tools/before_after.py OLD NEW [--rounds 5]

OLD and NEW are checkouts in which `./dev build` has run. Effects run alone, with the settings of docs/benchmarks/looks/each_effect.lua, as `bench` runs
them at 1920x1080: steady frames on its made scene, over a pass that copies it. Commands are measured from outside, as users wait for them. Both versions run one after the other in each round, the other one
first in the next; figures are medians. Needs oiiotool and two quiet cores; five
minutes for nine rounds.
"""
import argparse
import json
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

LOOKS = ["scatter_aces", "ten_effects"]  # of docs/benchmarks/looks


class Version:
    def __init__(self, checkout, work):
        self.home = os.path.abspath(checkout)
        self.program = os.path.join(self.home, "build/release/bin/afterglow")
        self.caches = tempfile.mkdtemp(dir=work)

    def run(self, *arguments, caches=None):
        """Seconds of a command."""
        caches = caches or self.caches
        environment = dict(os.environ, AFTERGLOW_HOME=self.home, AFTERGLOW_CACHE=os.path.join(caches, "own"),
                           MESA_SHADER_CACHE_DIR=os.path.join(caches, "mesa"))
        start = time.perf_counter()
        subprocess.run([self.program, *arguments], check=True, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return time.perf_counter() - start


def in_turns(versions, rounds, measure):
    """Medians by version of dictionaries that `measure` makes; a first round warms up."""
    samples = [[] for _ in versions]
    for turn in range(rounds + 1):
        order = range(len(versions)) if turn % 2 else reversed(range(len(versions)))
        for i in order:
            found = measure(versions[i])
            if turn > 0:
                samples[i].append(found)
    return [{key: statistics.median(s[key] for s in of_one) for key in of_one[0]} for of_one in samples]


def steady_frames(work, here):
    """A measurement of all looks, in copy passes."""
    folder = os.path.join(work, "looks")
    os.makedirs(folder)
    with open(os.path.join(here, "docs/benchmarks/looks/each_effect.lua"), encoding="utf-8") as look:
        effects = dict(re.findall(r"^  fx\.(\w+) \{ (.*?)(?:, )?enabled = false \},$", look.read(), re.M))
    for name, settings in effects.items():
        with open(os.path.join(folder, name + ".lua"), "w", encoding="utf-8") as look:
            look.write(f'local fx = require "afterglow"\nreturn fx.stack {{ name = "{name}", fx.{name} {{ {settings} }} }}\n')
    for name in LOOKS:
        shutil.copy(os.path.join(here, f"docs/benchmarks/looks/{name}.lua"), folder)
    goals = os.path.join(folder, "goals.json")
    with open(goals, "w", encoding="utf-8") as file:
        json.dump({"goals": [{"name": name, "sizes": ["1920x1080"], "over": [{"look": name + ".lua"}], "under": [{"copy": True}], "at_most": 1}
                             for name in [*effects, *LOOKS]]}, file)

    def measure(version):
        out = os.path.join(work, "bench")
        version.run("bench", "--goals", goals, "-o", out)
        with open(os.path.join(out, "bench.json"), encoding="utf-8") as file:
            return {goal["name"]: goal["measured"] for goal in json.load(file)["goals"]}

    return measure


def commands(work, here):
    """A measurement of whole commands, in seconds."""
    made = {}
    for size in "1920x1080", "3840x2160", "1280x720":
        made[size] = os.path.join(work, size + ".exr")
        channels = ",".join(f"ViewLayer.Combined.{c}" for c in "RGBA")
        subprocess.run(["oiiotool", os.path.join(here, "tests/images/neon.exr"), "--ch", channels, "--chnames", "R,G,B,A", "--resize:filter=triangle",
                        size, "-d", "half", "--compression", "zip", "-o", made[size]], check=True)
    sequence = os.path.join(work, "sequence")
    os.makedirs(sequence)
    for frame in range(1, 25):  # each another one: frames that repeat the one before are not made again
        subprocess.run(["oiiotool", made["1280x720"], "--cshift", f"+{8 * frame}+0", "-d", "half", "--compression", "zip",
                        "-o", os.path.join(sequence, f"in.{frame:04}.exr")], check=True)
    look = os.path.join(here, "docs/benchmarks/looks/scatter_aces.lua")
    pattern = os.path.join(sequence, "in.####.exr")

    def measure(version):
        out = os.path.join(work, "out")
        shutil.rmtree(out, ignore_errors=True)
        os.makedirs(out)
        with tempfile.TemporaryDirectory(dir=work) as empty:
            cold = version.run("run", look, made["1920x1080"], "-o", os.path.join(out, "cold.png"), caches=empty)
        return {
            "`check`": version.run("check", look),
            "one picture 1920×1080, EXR to PNG": version.run("run", look, made["1920x1080"], "-o", os.path.join(out, "hd.png")),
            "the same with empty caches": cold,
            "one picture 3840×2160, EXR to PNG": version.run("run", look, made["3840x2160"], "-o", os.path.join(out, "uhd.png")),
            "24 frames 1280×720, EXR to PNG": version.run("run", look, pattern, "-o", os.path.join(out, "f.####.png")),
            "24 frames 1280×720, EXR to EXR": version.run("run", look, pattern, "-o", os.path.join(out, "f.####.exr")),
        }

    return measure


def table(title, unit, medians, digits):
    before, now = medians
    print(f"| {title} | before{unit} | now{unit} | now ÷ before |\n|---|---|---|---|")
    for key in before:
        name = key if "`" in key or " " in key else f"`{key}`"
        print(f"| {name} | {before[key]:.{digits}f} | {now[key]:.{digits}f} | {now[key] / before[key]:.2f} |")
    print()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--rounds", type=int, default=5)
    a = parser.parse_args()
    here = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    with tempfile.TemporaryDirectory() as work:
        versions = [Version(a.old, work), Version(a.new, work)]
        table("1920×1080, copy passes", "", in_turns(versions, a.rounds, steady_frames(work, here)), 1)
        table("whole commands", ", s", in_turns(versions, a.rounds, commands(work, here)), 2)


if __name__ == "__main__":
    sys.exit(main())
