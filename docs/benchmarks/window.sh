#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What the window of `play` costs: processor time a frame of a 640×360 shot in windows of several sizes, over that of playing without a window
# at the same 24 frames a second, and as fast as it can.
#
#   docs/benchmarks/window.sh [PROGRAM] [PRESET]
#
# The shot is tests/images/neon.exr, 24 frames of which each has a brightness of its own. A real window under Xvfb, where the CPU draws, at 24 frames a second for
# ten seconds. Needs Xvfb, xdotool, oiiotool (openimageio-tools) and a quiet machine.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
program=${1:-$here/../../build/release/bin/afterglow} preset=${2:-$here/../../presets/neon_night.lua}
work=$(mktemp -d)
export XDG_CONFIG_HOME=$work XDG_STATE_HOME=$work  # settings and windows of whoever calls stay out of it
exec {display_pipe}<> <(:)
Xvfb -displayfd "$display_pipe" -screen 0 1920x1200x24 -noreset >/dev/null 2>&1 & server=$!
trap 'kill $server 2>/dev/null; rm -rf "$work"' EXIT
read -r -u "$display_pipe" number
export DISPLAY=:$number

for frame in $(seq 1 24); do
  oiiotool "$here/../../tests/images/neon.exr" --ch ViewLayer.Combined.R,ViewLayer.Combined.G,ViewLayer.Combined.B,ViewLayer.Combined.A --chnames R,G,B,A \
    --fullpixels --resize:filter=triangle 640x360 --mulc "$(awk "BEGIN { print 1 - $frame / 100 }")" -d half --compression zip -o "$work/$(printf %04d "$frame").exr"
done

ticks() { awk '{ print $14 + $15 }' "/proc/$1/stat"; }  # hundredths of a second of a processor
headless() { # COUNT OPTION…: seconds of a processor
  local TIMEFORMAT='%U %S'
  { time "$program" play "$preset" "$work/####.exr" --headless --count "$@" -q >/dev/null 2>&1; } 2>&1 | awk '{ print $1 + $2 }'
}
a_frame() { awk -v a="$(headless 24 "$@")" -v b="$(headless 264 "$@")" 'BEGIN { print (b - a) / 240 * 1000 }'; }

headless 24 --fast >/dev/null
fast=$(a_frame --fast) paced=$(a_frame) # a processor that rests between frames takes longer for each
printf '%s, %s, %s cores; without a window %.1f ms of a processor a frame, and %.1f as fast as it can (--fast)\n\n' \
  "$(date -u +%F)" "$("$program" --version | head -n1)" "$(nproc)" "$paced" "$fast"
echo "| window | between frames (median) | ms of a processor a frame | ÷ without a window | ÷ the same, --fast |"
echo "|---|---|---|---|---|"
for size in 900x600 1280x720 1440x900 1920x1080; do
  "$program" play "$preset" "$work/####.exr" --stats >"$work/stats" 2>&1 & player=$!
  window=
  # The window of the player before may still be found, but no longer be there.
  until [[ -n $window ]] && xdotool windowsize "$window" "${size%x*}" "${size#*x}" 2>/dev/null; do
    kill -0 $player
    window=$(xdotool search --class afterglow 2>/dev/null | tail -n1 || true)
  done
  sleep 3
  first=$(ticks $player)
  sleep 10
  used=$(($(ticks $player) - first))
  xdotool windowfocus "$window" key q
  wait $player || true
  median=$(sed -n 's/^between frames: median \([0-9.]*\).*/\1/p' "$work/stats")
  awk -v size="${size/x/×}" -v median="$median" -v used="$used" -v paced="$paced" -v fast="$fast" \
    'BEGIN { frames = 10 / (median > 41.7 ? median / 1000 : 1 / 24); ms = used * 10 / frames; printf "| %s | %s ms | %.1f | %.2f | %.2f |\n", size, median, ms, ms / paced, ms / fast }'
done
