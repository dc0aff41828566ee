#!/bin/bash
# Builds and runs the fuzz targets of test/fuzz.
set -euo pipefail

targets=(description scene motion bag npz messages tool)
seconds=20
jobs=1
seed=0
only_build=false
chosen=()

usage() {
  cat <<END
Usage: scripts/fuzz.sh [--build] [--seconds N] [--jobs N] [--seed N]
           [TARGET ...]

Gives inputs of random changes to what reads input, built with Clang's libFuzzer and the address and
undefined-behaviour sanitizers, and says of each target how many inputs it took and how many edges of
the code they reached. Whatever crashes, hangs, leaks or takes much memory is a finding.
  TARGET       ${targets[*]} (all of them)
  --build      only builds them
  --seconds N  for each target ($seconds)
  --jobs N     processes for each target ($jobs)
  --seed N     of the random changes, for the same ones again (another each time)
Starts from test/fuzz/corpus, and from what earlier runs have found in build/fuzz/corpus. Findings and
logs are in build/fuzz; to run one finding again, give it to the program in build/sanitized.
The exit status is 1 when there is a finding. Ctrl-C ends the run; what it has learnt stays.
END
}

number() {
  [[ "${2:-}" =~ ^[1-9][0-9]*$ ]] || { echo "fuzz.sh: $1 needs a number from 1 on" >&2; exit 2; }
  echo "$2"
}
while [[ $# -gt 0 ]]; do
  case "$1" in
    --build) only_build=true ;;
    --seconds) seconds=$(number "$@"); shift ;;
    --jobs) jobs=$(number "$@"); shift ;;
    --seed) seed=$(number "$@"); shift ;;
    -h | --help) usage; exit 0 ;;
    -*) echo "fuzz.sh: unknown option $1; --help names all" >&2; exit 2 ;;
    *)
      [[ " ${targets[*]} " == *" $1 "* ]] || {
        echo "fuzz.sh: there is no target $1; there are ${targets[*]}" >&2
        exit 2
      }
      chosen+=("$1") ;;
  esac
  shift
done
if [[ ${#chosen[@]} -eq 0 ]]; then chosen=("${targets[@]}"); fi

repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$repository"
build=$repository/build/sanitized
found=$repository/build/fuzz
seeds=$repository/test/fuzz
source scripts/running.sh
end_well fuzz.sh "what was learnt is in $found/corpus"
mkdir -p "$found"

run scripts/sanitized_build.sh "${chosen[@]/%/_fuzz}"
if $only_build; then exit 0; fi

# dictionary TARGET: prints its words; the whole tool has those of all files, and options.
dictionary() {
  case "$1" in
    tool) cat "$seeds"/dictionaries/*.dict ;;
    *) cat "$seeds/dictionaries/$1.dict" 2>/dev/null || true ;;
  esac
}

# statistic LOG NAME: the last value of a word in libFuzzer's lines.
statistic() {
  grep -E -o "$2: *[0-9]+" "$1" | tail -n 1 | grep -E -o '[0-9]+' || echo 0
}

# fuzz TARGET LOG [OPTION]...: runs a target and shows how far it is.
fuzz() {
  local begin=$SECONDS left status=0
  "$build/$1_fuzz" "${@:3}" >"$2" 2>&1 &
  while kill -0 $! 2>/dev/null; do
    left=$((seconds - SECONDS + begin))
    if [[ -t 2 ]]; then show "$1: $(statistic "$2" cov) edges, $((left > 0 ? left : 0)) s left"; fi
    sleep 0.5
  done
  show ''
  wait $! || status=$?
  return "$status"
}
show() {
  if [[ -t 2 ]]; then printf '\r\033[K%s' "$1" >&2; fi
}

failed=()
for target in "${chosen[@]}"; do
  log=$found/$target.log
  learnt=$found/corpus/$target
  mkdir -p "$learnt"
  dictionary "$target" >"$found/$target.dict"
  # Longer than any sensible input of this size takes under the sanitizers.
  options=(-max_total_time="$seconds" -timeout=20 -rss_limit_mb=2048 -max_len=8192 -print_final_stats=1
    -seed="$seed"
    -artifact_prefix="$found/$target-")
  if [[ -s "$found/$target.dict" ]]; then options+=(-dict="$found/$target.dict"); fi
  if [[ $jobs -gt 1 ]]; then options+=(-fork="$jobs"); fi
  begin=$SECONDS
  verdict=clean
  UBSAN_OPTIONS=print_stacktrace=1 run fuzz "$target" "$log" "${options[@]}" "$learnt" \
    "$seeds/corpus/$target" || verdict=FINDING
  printf '%-12s %-8s %10s inputs, %5s edges, %4d s\n' "$target" "$verdict" \
    "$(grep -E -o '^#[0-9]+' "$log" | tail -n 1 | tr -d '#')" "$(statistic "$log" cov)" \
    $((SECONDS - begin))
  if [[ $verdict == FINDING ]]; then
    failed+=("$target")
    grep -E 'finding:|ERROR:|runtime error:|SUMMARY:|Test unit written' "$log" >&2 ||
      tail -n 20 "$log" >&2
  fi
done
if [[ ${#failed[@]} -gt 0 ]]; then
  echo "fuzz.sh: findings in ${failed[*]}; logs and inputs are in $found" >&2
  exit 1
fi
