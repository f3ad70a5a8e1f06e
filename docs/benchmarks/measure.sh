#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Measures everything that docs/benchmarks shows, in less than eight minutes on two quiet cores:
#
#   docs/benchmarks/measure.sh [FOLDER]
#
# FOLDER (default docs/benchmarks) gets bench.json, bench.csv, bench.html, front.svg (the goals are in them) and calibration.json;
# commands.txt comes from commands.sh, pacing.txt from pacing.sh. A bench.json that is there already is compared with: the last lines are the ratios, and the exit
# code is 1 when something has become more than 1.15 times as slow.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
folder=${1:-docs/benchmarks}
./dev build >/dev/null
mkdir -p "$folder"

./dev calibrate -o "$folder/calibration.json"
docs/benchmarks/commands.sh >/dev/null
./dev bench presets/neon_night.lua --reload -o "$folder" >"$folder/reload.txt"
rm "$folder"/reload-*.json  # each sample; the table is enough here
docs/benchmarks/pacing.sh >/dev/null

compare=()
if [[ -f $folder/bench.json ]]; then
  old=$(mktemp)
  trap 'rm -f "$old"' EXIT
  cp "$folder/bench.json" "$old"
  compare=(--compare "$old")
fi
./dev bench docs/benchmarks/looks/scatter_aces.lua --sizes 1920x1080,3840x2160 --scaling 4096 --goals docs/benchmarks/goals.json \
  -o "$folder" ${compare[@]+"${compare[@]}"}
