#!/bin/bash
# Measures how large generated code is, and how much stack it takes.
set -euo pipefail

usage() {
  cat <<'END2'
Usage: scripts/generated_size.sh [--tool FILE] [--program FILE] SCENE...

Prints as CSV, for the code that inverse_dynamics_offline --generate makes of a robot, with efforts only
and with all reactions: operations of a sample, and bytes of instructions and of stack of the function for
one sample, of the one for blocks, and of the one for one sample as for a microcontroller (gcc -Os, sines
of the C library, no fused operations). The first two are gcc -O2 -mavx2 -mfma.
  --tool     path of inverse_dynamics_offline when it is built already; otherwise it is built, without
             ROS, in build/benchmark
  --program  the same of work_precision
  SCENE      a name that work_precision --list prints: six_axis_arm, chain_10, ...
END2
}

repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
program=generated_size.sh
source "$repository/scripts/counting.sh"
tool=
binary=
scenes=()
while [[ $# -gt 0 ]]; do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    --tool | --program)
      [[ $# -ge 2 ]] || { echo "generated_size.sh: $1 needs a value" >&2; exit 2; }
      if [[ "$1" == --tool ]]; then tool=$2; else binary=$2; fi
      shift ;;
    -*) echo "generated_size.sh: unknown option $1" >&2; usage >&2; exit 2 ;;
    *) scenes+=("$1") ;;
  esac
  shift
done
if [[ ${#scenes[@]} -eq 0 ]]; then
  echo "generated_size.sh: a scene is missing" >&2
  usage >&2
  exit 2
fi
need gcc
need nm

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
if [[ -z "$tool" ]]; then tool=$(built inverse_dynamics_offline); fi
if [[ -z "$binary" ]]; then binary=$(built work_precision); fi

# measure PATTERN OPTION...: compiles robot.c and prints the bytes of the functions whose names match,
# and the largest stack of a call: that of the function, and of the largest one that it calls.
measure() {
  local pattern=$1 code stack
  shift
  (cd "$work" && gcc -std=c99 -w "$@" -fstack-usage -c robot.c -o robot.o)
  code=$(nm -S -t d --defined-only "$work/robot.o" | awk -v pattern="$pattern" '
    $4 ~ pattern { sum += $2 } END { print sum + 0 }')
  stack=$(awk -F'[:\t]' -v pattern="$pattern" '
    $4 !~ pattern { next }
    $4 ~ /part_|library/ { if ($5 > part) part = $5; next }
    { own += $5 }
    END { print own + part }' "$work/robot.su")
  printf ',%s,%s' "$code" "$stack"
}

fused=(-O2 -mavx2 -mfma)
echo "scene,outputs,multiplications,additions,sines_and_cosines,code,stack,block_code,block_stack,small_code,small_stack"
for scene in "${scenes[@]}"; do
  "$binary" --description "$scene" >"$work/robot.urdf"
  for outputs in efforts efforts+reactions; do
    reactions=(--reactions none)
    if [[ $outputs == *reactions ]]; then reactions=(--reactions all --axes child); fi
    "$tool" --urdf "$work/robot.urdf" "${reactions[@]}" --generate "$work/robot.c" 2>"$work/notes" || {
      tail -n 1 "$work/notes" >&2
      exit 1
    }
    counts=$(sed -n 's/^.*Operations of a sample: \([0-9]*\) mul[a-z]*, \([0-9]*\) add[a-z]* (.*), \([0-9]*\) sines.*$/\1,\2,\3/p' "$work/robot.h")
    printf '%s,%s,%s' "$scene" "$outputs" "$counts"
    measure '^robot_(compute|part_[0-9]+|library_sines)$' "${fused[@]}"
    measure '^robot_(compute_block|pack_of_block|pack_part_[0-9]+)$' "${fused[@]}"
    measure '^robot_(compute|part_[0-9]+|library_sines)$' -Os -DROBOT_LIBM -DROBOT_FUSED=0
    echo
  done
done
