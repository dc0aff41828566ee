#!/bin/bash
# Measures and reports errors of the inverse dynamics where scenes go to extremes.
set -euo pipefail

usage() {
  cat <<END
Usage: scripts/stability.sh [--quick] [--no-install] [--output FOLDER] [--scene NAME]... [--list]

Installs what is needed, builds in build/benchmark (without ROS), computes, and writes into FOLDER
  stability.md            results, to be read first
  stability_<scene>.png   error over the varied parameter, one picture for each scene
  stability.csv           the measurements
  stability_details.csv   certificates, KDL's error over the bound, ours over a narrower one; for
                          closed loops, condition, rank, what is determined, and the completion
The exit status is 1 when an error is beyond its bound, a certificate beyond its limit, one of them is
not finite, or a closed loop's counts, flags or completion are wrong.
  --quick       fewer states of each scene: takes a minute or less once everything is built
  --no-install  do not install packages first
  --output      where to write (report/ in this repository)
  --scene       only this scene; may be repeated
  --list        print the scenes and the parameters that are varied in them
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
program=stability.sh
steps=4
source scripts/measuring.sh
if $list; then announce() { :; }; fi

end_well stability.sh "results of an earlier run, if any, are left in $output"
prepare "$install"
announce "Building in ${build#"$repository"/}, output in ${log#"$repository"/} ..."
build_programs stability
if $list; then exec "$build/benchmark/stability" "${scenes[@]}" --list; fi

announce "Computing in every way and in 113 bits"
measured=$(mktemp -d)  # results of an earlier run stay until there are new ones
temporary+=("$measured")
status=0
run "$build/benchmark/stability" "${quick[@]}" "${scenes[@]}" --output "$measured/stability.csv" \
  --details "$measured/stability_details.csv" || status=$?
[[ -f "$measured/stability.csv" && -f "$measured/stability_details.csv" ]] || exit "$status"
mv "$measured"/*.csv "$output"
announce "Pictures and table"
run /usr/bin/python3 benchmark/report/stability_page.py "${quick[@]}" "$output"
announce "Done: ${output}/stability.md"
exit "$status"
