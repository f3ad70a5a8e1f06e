#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What levels of ZIP and PNG take of a processor, and how long the files are.
#
#   docs/benchmarks/levels.sh [--program AFTERGLOW] [--picture FILE] [--rounds N]
#
# The picture, enlarged to 1920×1080 as half floats, goes through a look that does nothing, once for each level, on one processor; the table has the
# medians of what its report calls "encode": half floats or codes of the picture, PNG's filters, packing. "clean" is the picture behind a median of
# 5×5 pixels. Needs oiiotool (openimageio-tools) and taskset.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
program=$here/../../build/release/bin/afterglow picture=$here/../../tests/images/neon.exr rounds=5
while (($#)); do
  case $1 in
    --program) program=$2 ;; --picture) picture=$2 ;; --rounds) rounds=$2 ;;
    *) sed -n '3,9s/^# \?//p' "$0"; exit 2 ;;
  esac
  shift 2
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
prefix=
if oiiotool --info -v "$picture" | grep -q 'ViewLayer\.Combined\.R'; then prefix=ViewLayer.Combined.; fi
oiiotool "$picture" --ch "${prefix}R,${prefix}G,${prefix}B,${prefix}A=1" --chnames R,G,B,A --fullpixels --resize:filter=triangle 1920x1080 -d half --compression zip -o "$work/noisy.exr"
oiiotool "$work/noisy.exr" --median 5x5 -d half --compression zip -o "$work/clean.exr"
printf 'return require("afterglow").stack { name = "Nothing" }\n' >"$work/nothing.lua"

encode() { # PICTURE OUT OPTION…: median milliseconds, and MB
  local i
  for ((i = 0; i < rounds; ++i)); do
    taskset -c 0 "$program" run "$work/nothing.lua" "$work/$1.exr" -o "$work/$2" -q --report "$work/report.json" "${@:3}"
    grep -o '"encode": *[0-9.]*' "$work/report.json" | head -n 1 | grep -o '[0-9.]*'
  done | sort -n | awk '{ a[NR] = $0 } END { printf "%.0f ms", a[int((NR + 1) / 2)] }'
  printf ', %.1f MB' "$(stat -c %s "$work/$2" | awk '{ print $1 / 1e6 }')"
}

echo '| level | EXR, noisy | EXR, clean | PNG, noisy | PNG, clean |'
echo '|---|---|---|---|---|'
for level in 1 2 4 6; do
  printf '| %s |' "$level"
  for name in noisy clean; do printf ' %s |' "$(encode $name out.exr --compression "zip:$level")"; done
  for name in noisy clean; do printf ' %s |' "$(encode $name out.png --png-level "$level" --dither none)"; done
  echo
done
