#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes the table of blue noise that dithering into 8 bits uses: engine/image/blue_noise_table.inc.

Void and cluster (R. Ulichney, "The void-and-cluster method for dither array generation", 1993) on a torus of 64 x 64: every rank
0 ... 4095 once, so that each threshold of it spreads its pixels evenly. The same table every time: the start is a fixed sequence.
Takes about half a minute.
"""
import math
import sys

SIZE, SIGMA = 64, 1.9
COUNT = SIZE * SIZE

# How much a pixel that is set adds to every other one; (0, 0) is itself.
WEIGHT = [
    math.exp(-(min(x, SIZE - x) ** 2 + min(y, SIZE - y) ** 2) / (2 * SIGMA * SIGMA))
    for y in range(SIZE) for x in range(SIZE)
]


class Pattern:
    def __init__(self):
        self.bit = [False] * COUNT
        self.energy = [0.0] * COUNT

    def change(self, at, sign):
        self.bit[at] = sign > 0
        row, column = divmod(at, SIZE)
        energy = self.energy
        for y in range(SIZE):
            line = WEIGHT[((y - row) % SIZE) * SIZE:((y - row) % SIZE + 1) * SIZE]
            line = line[-column:] + line[:-column] if column else line
            base = y * SIZE
            for x in range(SIZE):
                energy[base + x] += sign * line[x]

    def cluster(self):
        """The set pixel that stands closest to others."""
        return max((at for at in range(COUNT) if self.bit[at]), key=lambda at: self.energy[at])

    def void(self):
        """The pixel that is not set and stands farthest from those that are."""
        return min((at for at in range(COUNT) if not self.bit[at]), key=lambda at: self.energy[at])


def start():
    pattern, state = Pattern(), 1
    while sum(pattern.bit) < COUNT // 10:
        state = (state * 1664525 + 1013904223) % 2**32
        at = (state >> 8) % COUNT
        if not pattern.bit[at]:
            pattern.change(at, 1)
    while True:  # evens it out
        cluster = pattern.cluster()
        pattern.change(cluster, -1)
        void = pattern.void()
        pattern.change(void, 1)
        if void == cluster:
            return pattern


def ranks():
    rank, first = [0] * COUNT, start()
    ones = sum(first.bit)
    pattern = Pattern()
    pattern.bit, pattern.energy = first.bit[:], first.energy[:]
    for value in range(ones - 1, -1, -1):
        at = pattern.cluster()
        pattern.change(at, -1)
        rank[at] = value
    for value in range(ones, COUNT):
        at = first.void()
        first.change(at, 1)
        rank[at] = value
    return rank


def main():
    rank = ranks()
    assert sorted(rank) == list(range(COUNT))
    out = open(sys.argv[1] if len(sys.argv) > 1 else "engine/image/blue_noise_table.inc", "w")
    out.write("// Made by tools/blue_noise.py: ranks 0 to 4095 of 64 rows of 64 pixels.\n")
    for i in range(0, COUNT, 32):
        out.write(", ".join(str(v) for v in rank[i:i + 32]) + ",\n")


main()
