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

# run NAME OPTIONS…: the example on the test picture, as $work/NAME.exr
run() {
  name=$1
  shift
  "$program" run "$preset" "$work/in.pfm" -o "$work/$name.exr" -q "$@" || fail "it does not run: $*"
}

same() { cmp -s "$work/$1.exr" "$work/$2.exr"; }

# Four by four pixels of linear light, from black to 16 times white, as 32-bit floats.
{
  printf 'PF\n4 4\n-1.0\n'
  for red in 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15; do
    for value in $red 5 $((15 - red)); do
      case $value in # 2^(value - 11), but for 0
        0) printf '\000\000\000\000' ;; 1) printf '\000\000\200\072' ;; 2) printf '\000\000\000\073' ;; 3) printf '\000\000\200\073' ;;
        4) printf '\000\000\000\074' ;; 5) printf '\000\000\200\074' ;; 6) printf '\000\000\000\075' ;; 7) printf '\000\000\200\075' ;;
        8) printf '\000\000\000\076' ;; 9) printf '\000\000\200\076' ;; 10) printf '\000\000\000\077' ;; 11) printf '\000\000\200\077' ;;
        12) printf '\000\000\000\100' ;; 13) printf '\000\000\200\100' ;; 14) printf '\000\000\000\101' ;; *) printf '\000\000\200\101' ;;
      esac
    done
  done
} >"$work/in.pfm"

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

# Hard pictures and settings, and what the effect says in `holds`. Longer runs find more: --for 10m.
"$program" stress --effect my_effect --path "$(dirname "$preset")" --cases 3000 --out "$work/stress" -q >"$work/stress.log" 2>&1 ||
  fail "stress: $(grep '^my_effect' "$work/stress.log" | head -1)"
echo "my_effect: passed"
