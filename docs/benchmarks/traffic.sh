#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The table of bytes in docs/benchmarks/README.md: docs/benchmarks/traffic.sh [SIZE]. Half floats, fused, as on a GPU.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
printf '| preset | moved (MiB) | of it small images | × unavoidable |\n|---|---|---|---|\n'
for preset in presets/*.lua presets/*/*.lua; do
  ./dev graph "$preset" --traffic --size "${1:-3840x2160}" | awk -v name="$(basename "$preset" .lua)" '
    function mib(number, unit) { return unit == "GiB" ? number * 1024 : unit == "KiB" ? number / 1024 : number }
    /^ *fused fp16 compute/ { printf "%s| `%s` | %.0f | %.0f | %.1f |\n", $NF " ", name, mib($4, $5), mib($6, $7), $NF; exit }'
done | sort -n -s | cut -d' ' -f2-
