#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Whether a long sequence takes more memory the longer it gets: resident memory over many small frames.
#
#   docs/benchmarks/memory.sh [--program AFTERGLOW] [--look FILE] [--frames N]
#
# The list of frames itself, with paths and times for the report, is made at the start: about 1.5 KiB a frame. Needs oiiotool
# (openimageio-tools). Files lie in $TMPDIR, and go.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
program=$here/../../build/release/bin/afterglow look=$here/looks/scatter_aces.lua frames=10000
while (($#)); do
  case $1 in
    --program) program=$2 ;; --look) look=$2 ;; --frames) frames=$2 ;;
    *) sed -n '3,8s/^# \?//p' "$0"; exit 2 ;;
  esac
  shift 2
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/in" "$work/out"
for i in 0 1 2 3; do
  oiiotool --create 160x90 3 --fill:color=0.1,0.2,0.3 160x90 --noise:type=gaussian:mean=0.5:stddev=0.3:seed=$i -d half --compression zip -o "$work/frame.$i.exr"
done
for ((i = 1; i <= frames; ++i)); do ln "$work/frame.$((i % 4)).exr" "$(printf '%s/in/%06d.exr' "$work" "$i")"; done
"$program" run "$look" "$work/in/######.exr" -o "$work/out/######.png" -q &
run=$!
next=$((frames / 10))
while kill -0 $run 2>/dev/null; do
  done=$(find "$work/out" -name '*.png' | wc -l)
  memory=$(awk '/^VmRSS/ { print $2 }' /proc/$run/status 2>/dev/null || true)
  if ((done >= next)) && [[ -n $memory ]]; then
    echo "$done frames: $memory KiB"
    next=$((next + frames / 10))
  fi
  sleep 0.2
done
wait $run
