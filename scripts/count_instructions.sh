#!/bin/bash
# Counts instructions per sample by callgrind.
set -euo pipefail

usage() {
  cat <<'END2'
Usage: scripts/count_instructions.sh [--samples N] [--method METHOD]... [--program FILE] SCENE...

Prints as CSV how many instructions a sample takes, for the package's own ways of computing it and for
KDL's solvers. Unlike times, they do not depend on what else the machine does. Builds with AVX-512 are
left out, as Valgrind does not know it.
  --samples   number of samples to count at least (64)
  --method    only this method; may be repeated (virtual_work, generated, kdl_chain, kdl_tree)
  --program   path of callgrind_sample when it is built already; otherwise it is built, without ROS,
              in build/benchmark
  SCENE       a name that work_precision --list prints: six_axis_arm, chain_100, ...
END2
}

repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
samples=64
methods=()
program=count_instructions.sh
binary=
scenes=()
source "$repository/scripts/counting.sh"
while [[ $# -gt 0 ]]; do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    --samples | --method | --program)
      [[ $# -ge 2 ]] || { echo "count_instructions.sh: $1 needs a value" >&2; exit 2; }
      case "$1" in
        --samples) samples=$2 ;;
        --method) methods+=("$2") ;;
        --program) binary=$2 ;;
      esac
      shift ;;
    -*) echo "count_instructions.sh: unknown option $1" >&2; usage >&2; exit 2 ;;
    *) scenes+=("$1") ;;
  esac
  shift
done
if [[ ${#scenes[@]} -eq 0 ]]; then
  echo "count_instructions.sh: a scene is missing" >&2
  usage >&2
  exit 2
fi
if [[ ! "$samples" =~ ^[1-9][0-9]*$ ]]; then
  echo "count_instructions.sh: --samples: '$samples' is not a positive number" >&2
  exit 2
fi
if [[ ${#methods[@]} -eq 0 ]]; then methods=(virtual_work generated kdl_chain kdl_tree); fi
need valgrind

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

if [[ -z "$binary" ]]; then binary=$(built callgrind_sample); fi

# wanted <contender>: whether the contender uses one of the methods, and valgrind can run it.
wanted() {
  local method
  [[ "$1" != *_avx512,* ]] || return 1
  for method in "${methods[@]}"; do
    [[ "$1" != "$method",* ]] || return 0
  done
  return 1
}

# show TEXT: one line of a terminal, which an empty text wipes out.
show() {
  if [[ -t 2 ]]; then printf '\r\033[K%s' "$1" >&2; fi
}

echo "scene,method,precision,mode,outputs,samples,instructions_per_sample"
for scene in "${scenes[@]}"; do
  "$binary" "$scene" >"$work/contenders"
  while IFS= read -r contender; do
    wanted "$contender" || continue
    show "$scene: $contender"
    if ! instructions=$(counted_by "$binary" "$scene" "$contender" "$samples"); then
      echo "count_instructions.sh: $scene: $contender: failed under valgrind" >&2
      exit 1
    fi
    counted=$(<"$work/output")
    echo "$scene,$contender,$counted,$(((instructions + counted / 2) / counted))"
  done <"$work/contenders"
done
show ''
