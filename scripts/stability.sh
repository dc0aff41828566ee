#!/bin/bash
# Errors of the inverse dynamics where scenes go to extremes, measured and reported.
set -euo pipefail

usage() {
  cat <<END
Usage: scripts/stability.sh [--quick] [--no-install] [--output FOLDER] [--scene NAME]... [--list]

Installs what is needed, builds in build/benchmark (without ROS), computes, and writes into FOLDER
  stability.md            the results; begin here
  stability_<scene>.png   error over what is varied, one picture for each scene
  stability.csv           the measurements
  stability_details.csv   certificates, KDL's error over the bound, ours over a narrower one; of
                          closed loops, condition, rank, what is determined, and the completion
Exit status 1 when an error is beyond its bound, a certificate beyond its limit, one of them is not
finite, or a closed loop's counts, flags or completion are wrong.
  --quick       fewer states of each scene: a minute or less once everything is built
  --no-install  do not install packages first
  --output      where to write (report/ in this repository)
  --scene       only this scene; may be repeated
  --list        name the scenes and what is varied in them
END
}

repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
install=true
list=false
quick=()
scenes=()
output=$repository/report
while [[ $# -gt 0 ]]; do
  case "$1" in
    --quick) quick=(--quick) ;;
    --no-install) install=false ;;
    --list) list=true ;;
    --output | --scene)
      [[ -n "${2:-}" ]] || { echo "stability.sh: $1 needs a value" >&2; exit 2; }
      if [[ "$1" == --output ]]; then output=$2; else scenes+=(--scene "$2"); fi
      shift ;;
    -h | --help) usage; exit 0 ;;
    *) echo "stability.sh: unknown option $1; --help names all" >&2; exit 2 ;;
  esac
  shift
done
if ! $list; then
  if ! { mkdir -p "$output" && [[ -w "$output" ]]; } 2>/dev/null; then
    echo "stability.sh: --output: cannot write into $output" >&2
    exit 1
  fi
  output=$(realpath "$output")
fi
cd "$repository"
build=$repository/build/benchmark
log=$repository/build/stability.log
export PATH=/usr/bin:$PATH PYTHONDONTWRITEBYTECODE=1

if $install; then scripts/install_dependencies.sh --build --benchmark; fi
/usr/bin/python3 -c 'import matplotlib' 2>/dev/null || {
  echo "stability.sh: Python's matplotlib is missing (Debian, Ubuntu: python3-matplotlib)" >&2
  exit 1
}

step=0
announce() {
  step=$((step + 1))
  if ! $list; then echo "[$step/4] $* ($SECONDS s)"; fi
}

announce "Building in ${build#"$repository"/}, output in ${log#"$repository"/} ..."
mkdir -p "$build"
if ! { cmake -S . -B "$build" -DCMAKE_BUILD_TYPE=Release -DVWD_CORE_ONLY=ON \
    -DVWD_BUILD_BENCHMARKS=ON -DBUILD_TESTING=OFF &&
    cmake --build "$build" --target stability -- -j"${JOBS:-$(nproc)}"; } >"$log" 2>&1; then
  grep -E -A 5 'error|Error' "$log" | head -n 40 >&2 || tail -n 40 "$log" >&2
  echo "stability.sh: the build failed; its whole output is in $log" >&2
  exit 1
fi
program=$build/benchmark/stability
if $list; then exec "$program" "${scenes[@]}" --list; fi

announce "Computing in every way and in 113 bits"
measured=$(mktemp -d)  # results of a run before stay until there are others
trap 'rm -rf "$measured"' EXIT
status=0
"$program" "${quick[@]}" "${scenes[@]}" --output "$measured/stability.csv" \
  --details "$measured/stability_details.csv" || status=$?
[[ -f "$measured/stability.csv" && -f "$measured/stability_details.csv" ]] || exit "$status"
mv "$measured"/*.csv "$output"
announce "Pictures and table"
/usr/bin/python3 benchmark/report/stability_page.py "${quick[@]}" "$output"
announce "Done: ${output}/stability.md"
exit "$status"
