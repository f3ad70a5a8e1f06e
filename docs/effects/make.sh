#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Writes docs/effects.md and its pictures: what the program says of each effect (`afterglow effects --markdown`), an example (NAME.lua
# here) and what it makes of a scene of tests/images/showcase. Needs jq and oiiotool. The examples are golden cases too (tests/golden), on other pictures.
#   docs/effects/make.sh [PROGRAM]     PROGRAM: ./dev unless given
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
program=${1:-./dev}
pictures=docs/images/effects
mkdir -p "$pictures"

# The examples are made for a scene that is darker.
exposure="--set color_adjustments.post_exposure=0.3"
usual="tests/images/showcase/alley.exr $exposure"

# An example may hold "-- input: FILE OPTION…" when another picture shows it better.
input() {
  local own
  own=$(sed -n 's/^-- input: //p' "docs/effects/$1.lua")
  printf '%s' "${own:-$usual}"
}

# One that changes single pixels may hold "-- zoom: X,Y,W,H": the part that is shown, each pixel as a square.
zoom() { sed -n 's/^-- zoom: //p' "docs/effects/$1.lua"; }

picture() { # OUT ZOOM PRESET INPUT OPTION…
  local out=$1 zoom=$2
  shift 2
  if [[ -z $zoom ]]; then
    "$program" run "$@" -o "$out" --jpeg-quality 82 -q
  else
    "$program" run "$@" --region "$zoom" -o "$work/part.png" -q
    oiiotool --nosoftwareattrib "$work/part.png" --ch R,G,B --resize:filter=box 960x540 --compression jpeg:88 -o "$out"
  fi
}

# The picture that an example is compared with: what before.lua makes of the same file. Prints its name.
before() { # ZOOM FILE …
  local zoom=$1 name options=
  shift
  name=$(basename "${1%.*}")
  name=before_${name%.*}${zoom:+_${zoom//,/_}}
  [[ $1 == tests/images/showcase/* ]] && options=$exposure
  [[ $* =~ --set\ color_adjustments.post_exposure=[0-9.-]+ ]] && options=${BASH_REMATCH[0]}
  [[ $* =~ --size\ [0-9x]+ ]] && options+=" ${BASH_REMATCH[0]}"
  [[ $* =~ --frames\ [0-9]+ ]] && options+=" ${BASH_REMATCH[0]}"
  # shellcheck disable=SC2086 # words of the options
  [[ $pictures/$name.jpg -nt $work/started ]] || picture "$pictures/$name.jpg" "$zoom" docs/effects/before.lua "$1" $options >&2
  printf '%s' "$name"
}

render() {
  # shellcheck disable=SC2046 # words of the line
  picture "$pictures/$1.jpg" "$(zoom "$1")" "docs/effects/$1.lua" $(input "$1")
}

# Passes, and the pixels they write in units of the picture; both at 1920x1080.
cost() {
  "$program" graph "docs/effects/$1.lua" --size 1920x1080 --format json | jq -r --arg name "$1" '
    [.graph.passes[] | select(.effect == $name)] as $passes
    | ($passes | map(.output.width * .output.height) | add / (1920 * 1080) * 100 | round / 100) as $pictures
    | if all($passes[]; .kind == "pixel") then "Cost: reads its own pixel alone and is fused with its neighbours; next to nothing."
      else "Cost: \($passes | length) \(if $passes | length == 1 then "pass that writes" else "passes that write" end) \($pictures) \(if $pictures == 1 then "picture" else "pictures" end) before passes are fused." end'
}

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
touch "$work/started"
names=$("$program" effects --json | jq -r '.[].name')
for name in $names; do render "$name"; done
{
  cat <<'INTRO'
# Effects

Made by docs/effects/make.sh from the effects themselves; `afterglow effects NAME` lists the same settings. Every setting has a default, so
`fx.vignette {}` is a whole entry. Effects run by injection point and order, wherever they stand in the list; `at` and `order` in an entry
move one. The pictures show what each example makes of a scene; all end with a neutral tone curve. [gallery.md](gallery.md) shows them all, small. The cost is counted in what
`afterglow graph docs/effects/NAME.lua --size 1920x1080 --format json` describes; `afterglow bench docs/effects/NAME.lua` measures times on your device.

INTRO
  for name in $names; do
    "$program" effects "$name" --markdown
    cost "$name"
    # shellcheck disable=SC2046 # words of the line
    printf '\n![%s](images/effects/%s.jpg "before: %s.jpg")\n\n```lua\n' "$name" "$name" "$(before "$(zoom "$name")" $(input "$name"))"
    sed -n "s/^  \(fx\.$name .*\),\$/\1/p" "docs/effects/$name.lua"
    printf '```\n\n'
  done
} >docs/effects.md
