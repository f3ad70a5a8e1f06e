#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Frames a second of whole sequences, from half ZIP EXR to PNG, EXR (ZIP, DWAA) and H.264, against other programs in turns.
#
#   docs/benchmarks/sequences.sh [--program AFTERGLOW] [--picture FILE] [--look FILE] [--peer PROGRAM] [--frames N] [--frames-4k N] [--rounds N]
#
# Frames are made from the picture: enlarged, moved by a few pixels from one to the next, with a renderer's noise, RGB without alpha. PROGRAM of
# --peer is called as `PROGRAM png|exr|dwaa IN OUT [IN OUT…]`, twice beside itself with half of the frames each and OMP_NUM_THREADS=1; kinds that
# it refuses are left out, and it must make the same picture: that of the first frame is compared. ffmpeg, where it is installed, can run no such look:
# it is measured against afterglow with a look that does nothing ("convert"), both to the same picture with the same settings: sRGB without noise,
# PNG with filters chosen by row at level 1, EXR of half floats in ZIP, H.264 of CRF 18 at the preset medium in the matrix of Rec. 709.
# Files lie in $TMPDIR (about 3 GB at a time), and go.
# The table has medians of the rounds: frames a second, processor time a frame, how much of all processors was used, and the size of a frame.
# Needs oiiotool (openimageio-tools) and a quiet machine.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
program=$here/../../build/release/bin/afterglow picture=$here/../../tests/images/neon.exr look=$here/looks/scatter_aces.lua peer='' frames=240 frames4k=48 rounds=3
while (($#)); do
  case $1 in
    --program) program=$2 ;; --picture) picture=$2 ;; --look) look=$2 ;; --peer) peer=$2 ;;
    --frames) frames=$2 ;; --frames-4k) frames4k=$2 ;; --rounds) rounds=$2 ;;
    *) sed -n '3,15s/^# \?//p' "$0"; exit 2 ;;
  esac
  shift 2
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cores=$(nproc)

make_frames() { # SIZE COUNT: 24 pictures, each linked as often as needed
  local size=$1 count=$2 i
  mkdir -p "$work/in"
  # A channel that is not there would be filled with 0.
  local prefix=
  if oiiotool --info -v "$picture" | grep -q 'ViewLayer\.Combined\.R'; then prefix=ViewLayer.Combined.; fi
  oiiotool "$picture" --ch "${prefix}R,${prefix}G,${prefix}B" --chnames R,G,B -o "$work/whole.exr"
  oiiotool "$work/whole.exr" --fullpixels --resize:filter=triangle "$size" -d float -o "$work/large.exr"
  for ((i = 0; i < 24 && i < count; ++i)); do
    oiiotool "$work/large.exr" --cshift "+$((8 * i))+0" \
      --create "$size" 3 --addc 1 --noise:type=gaussian:mean=0:stddev=0.1:mono=1:seed=$i --mul -d half --compression zip -o "$work/frame.$i.exr"
  done
  oiiotool --stats "$work/frame.0.exr" | awk '/Stats Max/ { exit !($3 > 0) }' || { echo "$picture: no light in R, G, B" >&2; exit 1; }
  for ((i = 0; i < count; ++i)); do ln "$work/frame.$((i % 24)).exr" "$(printf '%s/in/%04d.exr' "$work" "$i")"; done
}

pairs() { # EXTENSION FROM TO
  local i
  for ((i = $2; i < $3; ++i)); do printf '%s/in/%04d.exr %s/out/%04d.%s ' "$work" "$i" "$work" "$i" "$1"; done
}

output() { case $1 in h264) echo "$work/out/clip.mp4" ;; png) echo "$work/out/####.png" ;; *) echo "$work/out/####.exr" ;; esac; }

run_convert() {
  [[ $1 != dwaa ]] && command -v ffmpeg >/dev/null || return 1
  local more=(--dither none)
  case $1 in exr) more=(--compression zip) ;; h264) more+=(--output-space srgb) ;; esac
  "$program" run "$work/nothing.lua" "$work/in/####.exr" -o "$(output "$1")" -q "${more[@]}"
}

run_afterglow() {
  local more=()
  case $1 in dwaa) more=(--compression dwaa) ;; exr) more=(--compression zip) ;; esac
  "$program" run "$look" "$work/in/####.exr" -o "$(output "$1")" -q "${more[@]}"
}

run_peer() { # two processes
  [[ -n $peer && $1 != h264 ]] || return 1
  local extension=${1/dwaa/exr} half=$((count / 2)) first
  # shellcheck disable=SC2046
  OMP_NUM_THREADS=1 "$peer" "$1" $(pairs "$extension" 0 $half) & first=$!
  # shellcheck disable=SC2046
  OMP_NUM_THREADS=1 "$peer" "$1" $(pairs "$extension" $half "$count") && wait $first
}

run_ffmpeg() {
  command -v ffmpeg >/dev/null || return 1
  local to from=(-apply_trc iec61966_2_1)
  case $1 in
    png) to=(-pix_fmt rgb24 -compression_level 1 -pred mixed "$work/out/%04d.png") ;;
    exr) to=(-compression zip16 -format half "$work/out/%04d.exr") from=() ;;
    h264) to=(-vf scale=out_color_matrix=bt709:out_range=tv -pix_fmt yuv420p -c:v libx264 -crf 18 -preset medium "$work/out/clip.mp4") ;;
    *) return 1 ;;
  esac
  ffmpeg -v error -nostdin "${from[@]}" -framerate 24 -i "$work/in/%04d.exr" "${to[@]}"
}

measure() { # WHO KIND: frames a second, processor ms a frame, share of the processors' time, KiB a frame; or nothing
  rm -rf "$work/out" && mkdir "$work/out"
  local TIMEFORMAT='%R %U %S' times
  times=$( { time "run_$1" "$2" >/dev/null 2>"$work/errors"; } 2>&1 ) || { echo "" ; return; }
  awk -v n="$count" -v cores="$cores" -v bytes="$(find "$work/out" -type f -printf '%s\n' | awk '{ sum += $1 } END { print sum + 0 }')" \
    '{ printf "%.2f %.0f %.0f %.0f\n", n / $1, 1000 * ($2 + $3) / n, 100 * ($2 + $3) / ($1 * cores), bytes / n / 1024 }' <<<"$times"
}

same_picture() { # of both programs, in EXR without loss
  rm -rf "$work/out" && mkdir "$work/out"
  "$program" run "$look" "$work/in/0000.exr" -o "$work/out/a.exr" --compression zip -q
  OMP_NUM_THREADS=1 "$peer" exr "$work/in/0000.exr" "$work/out/b.exr"
  local off
  off=$(oiiotool "$work/out/a.exr" "$work/out/b.exr" --ch R,G,B --swap --ch R,G,B --diff | awk '/Mean error/ { print $4 }' || true)
  awk -v off="$off" 'BEGIN { exit !(off != "" && off < 1e-4) }' ||
    { echo "$peer makes another picture than $look: they differ by ${off:-?} in the mean" >&2; exit 1; }
}

median() { # WHO COLUMN
  [[ -s $work/result.$1 ]] || { echo "–"; return; }
  cut -d' ' -f"$2" "$work/result.$1" | sort -n | awk '{ a[NR] = $0 } END { print a[int((NR + 1) / 2)] }'
}
ratio() { awk -v a="$1" -v b="$2" 'BEGIN { if (a + 0 && b + 0) printf "%.2f", a / b; else printf "–" }'; }

declare -A name=([png]="PNG, 8 bits" [exr]="EXR, ZIP" [dwaa]="EXR, DWAA" [h264]="H.264")
declare -A label=([afterglow]="afterglow" [peer]="peer, two processes" [convert]="afterglow, no look" [ffmpeg]="ffmpeg, no look")
echo "$(date -u +%F), $("$program" --version | head -n1), $cores cores of $(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -n1), $rounds rounds"
for size in 1920x1080 3840x2160; do
  count=$frames
  [[ $size == 1920x1080 ]] || count=$frames4k
  ((count > 0)) || continue
  rm -rf "${work:?}"/*
  make_frames "$size" "$count"
  [[ -z $peer ]] || same_picture
  echo
  printf 'return require("afterglow").stack { name = "Nothing" }\n' >"$work/nothing.lua"
  echo "| $count frames $size, half ZIP EXR to | who | frames a second | ms of a processor a frame | processors used | KiB a frame | afterglow ÷ other |"
  echo "|---|---|---|---|---|---|---|"
  for kind in png exr dwaa h264; do
    rm -f "$work"/result.*
    for ((round = 0; round < rounds; ++round)); do
      for who in afterglow peer convert ffmpeg; do
        result=$(measure "$who" "$kind")
        if [[ -n $result ]]; then
          echo "$result" >>"$work/result.$who"
        elif [[ $who == afterglow ]]; then
          cat "$work/errors" >&2
        fi
      done
    done
    for who in afterglow peer convert ffmpeg; do
      [[ -s $work/result.$who ]] || continue
      other=
      [[ $who != peer ]] || other=$(ratio "$(median afterglow 1)" "$(median peer 1)")
      [[ $who != ffmpeg ]] || other=$(ratio "$(median convert 1)" "$(median ffmpeg 1)")
      echo "| ${name[$kind]} | ${label[$who]} | $(median $who 1) | $(median $who 2) | $(median $who 3) % | $(median $who 4) | $other |"
    done
  done
done
