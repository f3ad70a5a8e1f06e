# SPDX-License-Identifier: MIT
"""What a call from Python costs beside the engine's own work in that very call: cost.py PRESET [ROUNDS]

The engine's share is what report() says of the call: upload, execution and read-back."""
import statistics
import sys
import time

import numpy as np

import afterglow

stack = afterglow.Stack(sys.argv[1])
rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 30
source = ((np.arange(1080 * 1920 * 4, dtype=np.int64) * 37 % 101) / 32).astype(np.float32).reshape(1080, 1920, 4)
source[..., 3] = 1
out = np.empty_like(source)


def measure(**arguments):
    start = time.perf_counter()
    stack.run(source, **arguments)
    total = (time.perf_counter() - start) * 1e3
    times = stack.report()["milliseconds"]
    return total, times["upload"] + times["execute"] + times["read_back"]


for name, arguments in (("into a given array", {"out": out}), ("into a new array", {})):
    for _ in range(2):
        measure(**arguments)
    figures = [measure(**arguments) for _ in range(rounds)]
    print(f"{name}: call {statistics.median(f[0] for f in figures):.2f} ms, engine {statistics.median(f[1] for f in figures):.2f} ms, "
          f"median of the ratios {statistics.median(f[0] / f[1] for f in figures):.4f}")
