#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Writes docs/effects.md and its pictures: what the program says of each effect (`afterglow effects --markdown`), an example (NAME.lua
# here) and what it makes of tests/images/neon.exr. Needs jq. The examples are golden cases too (tests/golden).
#   docs/effects/make.sh [PROGRAM]     PROGRAM: ./dev unless given
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
program=${1:-./dev}
pictures=docs/images/effects
mkdir -p "$pictures"

# An example may hold "-- input: FILE OPTION…" when it needs another picture than the usual one.
render() {
  local input
  input=$(sed -n 's/^-- input: //p' "docs/effects/$1.lua")
  # shellcheck disable=SC2086 # words of the line
  "$program" run "docs/effects/$1.lua" ${input:-tests/images/neon.exr --size 320x180} -o "$pictures/$1.jpg" --jpeg-quality 82 -q
}

# Passes, and the pixels they write in units of the picture; both at 1920x1080.
cost() {
  "$program" graph "docs/effects/$1.lua" --size 1920x1080 --format json | jq -r --arg name "$1" '
    [.graph.passes[] | select(.effect == $name)] as $passes
    | ($passes | map(.output.width * .output.height) | add / (1920 * 1080) * 100 | round / 100) as $pictures
    | if all($passes[]; .kind == "pixel") then "Cost: reads its own pixel alone and is fused with its neighbours; next to nothing."
      else "Cost: \($passes | length) \(if $passes | length == 1 then "pass that writes" else "passes that write" end) \($pictures) \(if $pictures == 1 then "picture" else "pictures" end) before passes are fused." end'
}

render before
names=$("$program" effects --json | jq -r '.[].name')
for name in $names; do render "$name"; done
{
  cat <<'INTRO'
# Effects

Made by docs/effects/make.sh from the effects themselves; `afterglow effects NAME` tells the same. Every setting has a default, so
`fx.vignette {}` is a whole entry. Effects run by injection point and order, wherever they stand in the list; `at` and `order` in an entry
move one. The pictures show what each example makes of the first picture; all end with a neutral tone curve. The cost is counted in what
`afterglow graph docs/effects/NAME.lua --size 1920x1080 --format json` describes; `afterglow bench docs/effects/NAME.lua` measures times on your device.

![before](images/effects/before.jpg)

INTRO
  for name in $names; do
    "$program" effects "$name" --markdown
    cost "$name"
    printf '\n![%s](images/effects/%s.jpg)\n\n```lua\n' "$name" "$name"
    sed -n "s/^  \(fx\.$name .*\),\$/\1/p" "docs/effects/$name.lua"
    printf '```\n\n'
  done
} >docs/effects.md
