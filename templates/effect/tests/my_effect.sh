#!/bin/sh
# Tests the effect my_effect. AFTERGLOW names the program (default: afterglow).
set -eu
program=${AFTERGLOW:-afterglow}
preset=$(cd "$(dirname "$0")/.." && pwd)/my_effect.lua
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
  echo "my_effect: FAILED: $1" >&2
  exit 1
}

# run NAME OPTIONS…: the example on the test picture, as $work/NAME.png
run() {
  name=$1
  shift
  "$program" run "$preset" "$work/in.ppm" -o "$work/$name.png" -q "$@" || fail "it does not run: $*"
}

same() { cmp -s "$work/$1.png" "$work/$2.png"; }

# Four by four pixels, from dark to bright.
{
  echo P3 4 4 255
  for value in 0 1 16 32 48 64 80 96 112 128 144 160 192 224 254 255; do echo "$value 64 $((255 - value))"; done
} >"$work/in.ppm"

"$program" check "$preset" >/dev/null || fail "check finds an error"
run off --set my_effect.enabled=false
run none --set my_effect.strength=0
run half --set my_effect.strength=0.5
run full --set my_effect.strength=1
run again --set my_effect.strength=0.5
run alone --set my_effect.strength=0.5 --reference

same off none || fail "strength = 0 changes the picture"
same off half && fail "strength = 0.5 does not change the picture"
same half full && fail "strength does not matter"
same half again || fail "the same frame is not the same twice"
same half alone || fail "joined with other passes it gives another picture"
echo "my_effect: passed"
