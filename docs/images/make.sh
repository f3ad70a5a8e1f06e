#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Renders every preset for the README, and docs/gallery.md: all presets and effects, small. docs/effects/make.sh renders the effects: run
# it first. Needs jq.
#   docs/images/make.sh [PROGRAM]     PROGRAM: ./dev unless given
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
program=${1:-./dev}
alley=tests/images/showcase/alley.exr sea=tests/images/showcase/sea.exr photo=tests/images/ldr/rocket.jpg

render() { # NAME PRESET INPUT OPTION…
  "$program" run "$2" "$3" -o "docs/images/$1.jpg" --jpeg-quality 82 -q "${@:4}"
}

# The scene that shows a preset best.
scene() { # NAME
  case $1 in
    filmic_scatter | golden_hour | day_for_night | faded_film | teal_orange | portrait_haze | dream_haze | print) printf %s "$sea" ;;
    ldr_glow) printf %s "$photo" ;;
    *) printf %s "$alley" ;;
  esac
}

# What it is for: the first sentence of the comment that it begins with.
story() { # FILE
  sed '/SPDX/d; /^--/!Q; s/^-- *//' "$1" | tr '\n' ' ' | sed 's/\([^.]*\)\..*/\1/; s/ *$//'
}

cell() { # PICTURE LINK NAME TEXT
  printf '<td width="33%%"><a href="%s"><img src="%s" width="320" alt="%s"></a><br><code>%s</code>: %s</td>\n' "$2" "$1" "$3" "$3" "$4"
}

# Rows of three of what `cell` printed.
rows() { awk 'NR % 3 == 1 { print "<tr>" } { print } NR % 3 == 0 { print "</tr>"; next } END { if (NR % 3) print "</tr>" }'; }

presets=()
for file in presets/*.lua presets/*/*.lua; do
  grep -q 'fx.stack' "$file" && presets+=("$file")
done

for name in alley sea; do render "before_$name" presets/plain_aces.lua "${!name}" --set tone_mapping.mode=none; done
render before_rocket presets/plain_aces.lua "$photo" --set tone_mapping.mode=none
for file in "${presets[@]}"; do
  name=$(basename "$file" .lua)
  render "$name" "$file" "$(scene "$name")"
done
"$program" graph presets/neon_night.lua --size 64x36 -o docs/images/graph.svg

{
  cat <<'INTRO'
# Gallery

Made by docs/images/make.sh. A picture leads to the preset, or to what [effects.md](effects.md) says of the effect.

## Presets

<table>
INTRO
  for file in "${presets[@]}"; do
    name=$(basename "$file" .lua)
    cell "images/$name.jpg" "../$file" "$name" "$(story "$file")"
  done | rows
  printf '</table>\n\n## Effects\n\n<table>\n'
  "$program" effects --json | jq -r '.[] | .name + "\t" + (.doc | split("\n")[0])' | while IFS=$'\t' read -r name doc; do
    cell "images/effects/$name.jpg" "effects.md#$name" "$name" "${doc%.}"
  done | rows
  printf '</table>\n'
} >docs/gallery.md
