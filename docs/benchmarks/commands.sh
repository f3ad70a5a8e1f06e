#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Measures whole commands as users run them: neon_night on 1920×1080 and 3840×2160 enlargements of tests/images/neon.exr.
# Writes docs/benchmarks/commands.txt; a part of measure.sh. Needs /usr/bin/time (package `time`), oiiotool (openimageio-tools) and a quiet machine.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
./dev build >/dev/null
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
out=docs/benchmarks/commands.txt

for size in 1920x1080 3840x2160; do
  oiiotool tests/images/neon.exr --ch ViewLayer.Combined.R,ViewLayer.Combined.G,ViewLayer.Combined.B,ViewLayer.Combined.A \
    --chnames R,G,B,A --resize:filter=triangle "$size" -d half --compression zip -o "$work/$size.exr"
done

run() { /usr/bin/time -f "  whole command: %e s, peak %M KiB" ./dev run presets/neon_night.lua "$@" --stats 2>&1; }

{
  echo "# $(date -u +%F), $(git describe --always --dirty), $(nproc) cores of $(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -n1)"
  for size in 1920x1080 3840x2160; do
    echo; echo "## $size half ZIP EXR to 8-bit PNG, all caches empty"
    AFTERGLOW_CACHE=$work/cold MESA_SHADER_CACHE_DIR=$work/cold-mesa run "$work/$size.exr" -o "$work/out.png"
    rm -rf "$work/cold" "$work/cold-mesa"
    run "$work/$size.exr" -o "$work/out.png" >/dev/null
    for i in 1 2 3; do echo; echo "## $size, warm, run $i"; run "$work/$size.exr" -o "$work/out.png"; done
    for i in 1 2 3; do echo; echo "## $size, warm, --reference (every pass on its own), run $i"; run "$work/$size.exr" -o "$work/out.png" --reference; done
  done
} | tee "$out"
