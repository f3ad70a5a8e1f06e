#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Renders the pictures of the README with the program itself, from pictures that the tests use.
#   docs/images/make.sh [PROGRAM]     PROGRAM: ./dev unless given
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
program=${1:-./dev}
render() { # NAME PRESET INPUT OPTION…
  "$program" run "presets/$2" "tests/images/$3" -o "docs/images/$1" --jpeg-quality 82 "${@:4}"
}
render before.jpg plain_aces.lua neon.exr --size 640x360 --set tone_mapping.mode=none
for preset in neon_night neon_additive filmic_scatter portrait_haze ink_outline night_vision animation_safe plain_aces \
  anamorphic_night faded_film vhs_tape shallow_focus; do
  render "$preset.jpg" "$preset.lua" neon.exr --size 640x360
done
render print.jpg print/print.lua neon.exr --size 640x360
render ldr_before.jpg plain_aces.lua ldr/rocket.jpg --set tone_mapping.mode=none
render ldr_glow.jpg ldr_glow.lua ldr/rocket.jpg
"$program" graph presets/neon_night.lua --size 64x36 -o docs/images/graph.svg
