#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Takes the pictures of docs/player.md: the real window, on a display that nobody sees. Needs Xvfb, xdotool and ImageMagick.
#   docs/images/player.sh PROGRAM      PROGRAM: build/release/bin/afterglow
set -euo pipefail
[[ $# -eq 1 ]] || { sed -n '3,4s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; exit 2; }
program=$(realpath "$1")
project=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
work=$(mktemp -d)
trap 'kill "${play:-}" "${display_server:-}" 2>/dev/null || true; rm -rf "$work"' EXIT
cp "$project/presets/neon_night.lua" "$work/look.lua"
cp "$project/tests/images/neon.exr" "$work/neon.exr"
cd "$work"
export XDG_CONFIG_HOME=$work XDG_STATE_HOME=$work  # as for somebody new
mkfifo number
Xvfb -displayfd 3 -screen 0 1280x800x24 -noreset 3>number 2>/dev/null & display_server=$!
read -r number <number
export DISPLAY=":$number"
"$program" play look.lua neon.exr -v >log 2>&1 & play=$!
# Until the log has the text so many times; a minute at most.
wait_for() { for _ in $(seq 600); do [[ $(grep -c "$1" log) -ge $2 ]] && return; sleep 0.1; done; echo "player.sh: no '$1'" >&2; exit 1; }
wait_for "shown neon.exr" 1
xdotool mousemove 330 300 key ctrl+a
sleep 3  # the effects are read, and drawn
xdotool type lens
sleep 2
import -window root "$work/player.png"
convert "$work/player.png" -resize 1000x -quality 80 "$project/docs/images/player.jpg"
xdotool key Escape
sleep 1
xdotool key h key h key h key h key h
xdotool keydown ctrl mousemove 100 150 mousedown 1 mousemove 150 240 mousemove 270 300 mouseup 1 keyup ctrl
sleep 3
import -window root "$work/scopes.png"
convert "$work/scopes.png" -resize 1000x -quality 80 "$project/docs/images/player_scopes.jpg"
