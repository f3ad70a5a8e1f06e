#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs the fuzzers that are built, one process at a time. `./dev fuzz` builds them and calls this.
#
#   run.sh FOLDER all|HARNESS… [SECONDS]   fuzz each for so long (60); FOLDER is the build folder, where the grown
#                                          corpora, findings and the ledger of all runs lie
#   run.sh FOLDER merge [HARNESS…]         adds the few inputs to the archives of tests/fuzz/corpus that reach all edges of the grown corpora
#   run.sh FOLDER report                   minutes, executions and coverage of each harness over all runs
#
# Exit code 1 when something was found.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
work=$(cd "$1" && pwd)
shift
ledger=$work/fuzz-ledger.tsv
TMPDIR=$([[ -w /dev/shm ]] && echo /dev/shm || echo "${TMPDIR:-/tmp}")
export TMPDIR
export LSAN_OPTIONS=suppressions=$here/../suppressions/leak.supp:print_suppressions=0
export AFTERGLOW_HOME=$here/../.. XDG_RUNTIME_DIR=${XDG_RUNTIME_DIR:-$work}

# Limits by harness: longest input, bytes of one allocation. The image reader is told that a picture may take 32 MiB.
limits() {
  case $1 in
    image) echo "-max_len=65536 -malloc_limit_mb=160" ;;
    pack) echo "-max_len=16384 -malloc_limit_mb=64" ;;
    lut | preset | write_back | shader) echo "-max_len=16384" ;;
    json) echo "-max_len=8192" ;;
    sound | stream) echo "-max_len=32768" ;;
    *) echo "-max_len=1024" ;;
  esac
}

dictionary() {
  case $1 in
    preset | write_back | settings) echo "-dict=$here/dictionaries/lua.dict" ;;
    shader | json | command_line | image) echo "-dict=$here/dictionaries/$1.dict" ;;
  esac
}

names() {
  for archive in "$here"/corpus/*.tar.zst; do basename "$archive" .tar.zst; done
}

# The harness of pictures sees into the decoders of ./dev fuzz decoders; they are given a null pointer where a file asks for too much.
with_decoders() {
  local built=$work/decoders
  if [[ $1 == image && -f $built/.built ]]; then
    env LD_LIBRARY_PATH="$built/root/lib" ASAN_OPTIONS=detect_odr_violation=0:allocator_may_return_null=1 "${@:2}"
  else
    "${@:2}"
  fi
}

# Folders of the inputs that the project keeps: the archive, as the build unpacks it, and what something was found with.
seeds() {
  echo "$work/tests/fuzz/corpus/$1"
  [[ ! -d $here/found/$1 ]] || echo "$here/found/$1"
}

fuzz_one() {
  local name=$1 seconds=$2 grown=$work/fuzz-corpus/$1 log=$work/fuzz-$1.log status=0 started cpu
  mkdir -p "$grown" "$work/fuzz-findings"
  started=$(date +%s)
  TIMEFORMAT='%U %S'
  # shellcheck disable=SC2046
  cpu=$({ time with_decoders "$name" nice -n 19 "$work/tests/fuzz/fuzz_$name" -max_total_time="$seconds" -timeout=60 -rss_limit_mb=2048 -print_final_stats=1 \
    -close_fd_mask=1 -artifact_prefix="$work/fuzz-findings/$name-" $(limits "$name") $(dictionary "$name") \
    "$grown" $(seeds "$name") >"$log" 2>&1; } 2>&1) || status=$?
  local runs cov features
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  [[ -n $runs ]] || runs=$(grep -aoE '^#[0-9]+' "$log" | tail -n 1 | tr -d '#')
  cov=$(grep -aoE 'cov: [0-9]+' "$log" | tail -n 1 | cut -d' ' -f2)
  features=$(grep -aoE 'ft: [0-9]+' "$log" | tail -n 1 | cut -d' ' -f2)
  printf '%s\t%s\t%s\t%s\t%s\t%s\t%s\n' "$name" "$(($(date +%s) - started))" "$(awk '{print $1 + $2}' <<<"$cpu")" "${runs:-0}" "${cov:-0}" "${features:-0}" \
    "$status" >>"$ledger"
  printf '%s: %s executions, coverage %s%s\n' "$name" "${runs:-0}" "${cov:-0}" "$([[ $status -eq 0 ]] || echo ", FINDING: see $log")"
  return "$status"
}

merge_one() {
  local name=$1 both before list
  both=$(mktemp -d "$work/merge.XXXXXX") list=$(mktemp "$work/merge-list.XXXXXX")
  cp "$work/tests/fuzz/corpus/$name"/* "$both"
  before=$(find "$both" -type f | wc -l)
  # shellcheck disable=SC2046
  with_decoders "$name" "$work/tests/fuzz/fuzz_$name" -set_cover_merge=1 -use_counters=0 -timeout=60 -rss_limit_mb=2048 -close_fd_mask=1 $(limits "$name") \
    "$both" "$work/fuzz-corpus/$name" >"$work/fuzz-merge.log" 2>&1
  # The same inputs always give the same archive.
  (cd "$both" && find . -type f -printf '%P\n' | LC_ALL=C sort >"$list" &&
    cmake -E tar c "$here/corpus/$name.tar.zst" --zstd --mtime=2026-01-01 --files-from="$list")
  printf '%s: %s inputs, %s of them new\n' "$name" "$(find "$both" -type f | wc -l)" "$(($(find "$both" -type f | wc -l) - before))"
  rm -rf "$both" "$list"
}

report() {
  printf '%-14s %8s %9s %12s %9s %9s\n' harness 'wall min' 'cpu min' executions edges features
  sort "$ledger" | awk -F'\t' '
    { wall[$1] += $2; cpu[$1] += $3; runs[$1] += $4; if ($5 > cov[$1]) cov[$1] = $5; if ($6 > ft[$1]) ft[$1] = $6 }
    END { for (n in wall) printf "%-14s %8.1f %9.1f %12d %9d %9d\n", n, wall[n] / 60, cpu[n] / 60, runs[n], cov[n], ft[n] }' | sort
}

case ${1:-all} in
  report) report ;;
  merge)
    shift
    for name in ${*:-$(names)}; do merge_one "$name"; done
    ;;
  *)
    chosen=() seconds=60 status=0
    for word in "$@"; do
      if [[ $word =~ ^[0-9]+$ ]]; then seconds=$word; else chosen+=("$word"); fi
    done
    [[ ${#chosen[@]} -gt 0 && ${chosen[0]} != all ]] || mapfile -t chosen < <(names)
    for name in "${chosen[@]}"; do fuzz_one "$name" "$seconds" || status=1; done
    exit $status
    ;;
esac
