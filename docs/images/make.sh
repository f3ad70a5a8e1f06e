#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Renders every preset for the README, docs/looks.md (presets large, beside what went in, and on four pictures) and docs/gallery.md (presets
# and effects, small). docs/effects/make.sh renders the effects: run it first. Needs jq, oiiotool and ImageMagick.
#   docs/images/make.sh [PROGRAM]     PROGRAM: ./dev unless given
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
program=${1:-./dev}
alley=tests/images/showcase/alley.exr sea=tests/images/showcase/sea.exr photo=tests/images/ldr/rocket.jpg hdri=tests/images/hdri/sunset.exr

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

# The name of that scene's picture as it is.
before() { basename "$(scene "$1")" | sed 's/^/before_/; s/\..*//'; } # NAME

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

Made by docs/images/make.sh. A picture leads to the preset in [looks.md](looks.md), or to what [effects.md](effects.md) says of the effect.

## Presets

<table>
INTRO
  for file in "${presets[@]}"; do
    name=$(basename "$file" .lua)
    cell "images/$name.jpg" "looks.md#$name" "$name" "$(story "$file")"
  done | rows
  printf '</table>\n\n## Effects\n\n<table>\n'
  "$program" effects --json | jq -r '.[] | .name + "\t" + (.doc | split("\n")[0])' | while IFS=$'\t' read -r name doc; do
    cell "images/effects/$name.jpg" "effects.md#$name" "$name" "${doc%.}"
  done | rows
  printf '</table>\n'
} >docs/gallery.md

clipping="tools/clipping.py $program $alley $sea $hdri $photo --sheet docs/images/looks.jpg"
{
  cat <<'INTRO'
# Looks

Made by docs/images/make.sh. Each preset on the scene that shows it best; on the site a slider shows what went in. `afterglow run NAME PICTURE -o out.png` makes one, from any folder.

`anime_night`, `clean_product`, `dream_haze`, `golden_hour`, `neon_noir` and `shallow_focus` use depth, `ink_outline` depth and normals: channels of the picture, or `--depth FILE` and `--normal FILE`. Without them those entries are skipped, with a warning.

INTRO
  for file in "${presets[@]}"; do
    name=$(basename "$file" .lua)
    printf '## %s\n\n%s. [%s](../%s)\n\n![%s](images/%s.jpg "before: %s.jpg")\n\n' "$name" "$(story "$file")" "$file" "$file" "$name" "$name" "$(before "$name")"
  done
  cat <<'TEXT'
## All on four pictures

A street at night and a terrace at sunset (Blender), an HDR photograph (a whole surrounding, by Greg Zaal) and a photograph of 8 bits (SpaceX), without any change to the presets.

![every preset on four pictures](images/looks.jpg)

## What they clip

The share of pixels with a channel at 255, in percent. In brackets: by how many percentage points that is more than with the preset's tone curve alone. More than 5 points count as a fault. (`tools/clipping.py` is in the source.)

TEXT
  printf '`%s`\n\n' "${clipping/$program/PROGRAM}"
  $clipping
  cat <<'TEXT'

## More figures

| | |
|---|---|
| how close a small preview comes to the whole picture, by effect | [math.md §23](math.md#23-lengths) |
| colours at soft edges, by effect | [alpha.md](alpha.md) |
| what each effect costs: 1 is the time in which the device copies the picture once | [benchmarks](benchmarks/README.md) |
| `depth_of_field` and `bokeh_blur`, before and now | [picture](images/blurs_before_after.jpg) |
| what tone curves do to greys and colours | [tone_mapping.md](tone_mapping.md) |
TEXT
} >docs/looks.md
