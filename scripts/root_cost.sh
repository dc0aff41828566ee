#!/bin/bash
# What a root that moves costs beside one more revolute joint: instructions by callgrind, and times.
set -euo pipefail

usage() {
  cat <<'END2'
Usage: scripts/root_cost.sh [--reactions] [--program FILE]

Prints for chains of revolute joints how many instructions (AVX2 at most, as Valgrind does not know
AVX-512) and how much time a sample takes with a resting and with a moving root, and their difference in
joints: in what a joint more costs, the slope from the chain to one of twice its length.
  --reactions  all reactions, too, and not only efforts
  --program    path of root_cost when it is built already; otherwise it is built, without ROS, in
               build/benchmark
END2
}

repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
program=root_cost.sh
options=()
binary=
source "$repository/scripts/counting.sh"
while [[ $# -gt 0 ]]; do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    --reactions) options+=(--reactions) ;;
    --program)
      [[ $# -ge 2 ]] || { echo "root_cost.sh: $1 needs a value" >&2; exit 2; }
      binary=$2
      shift ;;
    *) echo "root_cost.sh: unknown option $1" >&2; usage >&2; exit 2 ;;
  esac
  shift
done
need valgrind

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
if [[ -z "$binary" ]]; then binary=$(built root_cost); fi

# count LINKS ROOT: prints the instructions of a sample.
count() {
  counted_by "$binary" --links "$1" "--$2" "${options[@]}" || {
    echo "root_cost.sh: $1 links, $2: failed under valgrind" >&2
    exit 1
  }
}

"$binary" "${options[@]}" >"$work/times"
links=(4 8 16 32)
for i in "${links[@]}"; do
  for root in resting moving; do
    instructions=$(count "$i" "$root")
    echo "instructions,$i,$root,$((instructions / 64))"
  done
done >"$work/table"
sed -n '2,$s/^/ns,/p' "$work/times" >>"$work/table"
awk -F, '
  { value[$1, $2, $3] = $4 }
  END {
    print "what,links,resting,moving,of_a_joint,moving_root_in_joints"
    for (w = 1; w <= 2; ++w) {
      what = w == 1 ? "instructions" : "ns"
      for (n = 4; n <= 16; n *= 2) {
        rest = value[what, n, "resting"]
        slope = (value[what, 2 * n, "resting"] - rest) / n
        moving = value[what, n, "moving"]
        printf "%s,%d,%s,%s,%.1f,%.2f\n", what, n, rest, moving, slope, (moving - rest) / slope
      }
    }
  }' "$work/table"
