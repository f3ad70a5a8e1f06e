#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Measures how evenly playback goes without a window: 240 frames of a sequence of 24 (tests/images/neon.exr, a brightness for each), by the clock at
# 24 fps and as fast as it goes. Writes docs/benchmarks/pacing.txt; a part of measure.sh. Needs oiiotool (openimageio-tools) and a quiet machine.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
./dev build >/dev/null
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

for size in 1280x720 1920x1080; do
  for frame in $(seq 1 24); do
    oiiotool tests/images/neon.exr --ch ViewLayer.Combined.R,ViewLayer.Combined.G,ViewLayer.Combined.B,ViewLayer.Combined.A --chnames R,G,B,A \
      --resize:filter=triangle "$size" --mulc "$(awk "BEGIN { print 1 - $frame / 100 }")" -d half --compression zip \
      -o "$work/$size.$(printf %04d "$frame").exr"
  done
done

{
  echo "# $(date -u +%F), $(git describe --always), $(nproc) cores of $(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -n1)"
  for size in 1280x720 1920x1080; do
    for how in --real-time --fast; do
      echo; echo "## $size $how"
      ./dev play presets/neon_night.lua "$work/$size.####.exr" --headless --count 240 --loop loop "$how" --stats 2>&1
    done
  done
} | tee docs/benchmarks/pacing.txt
