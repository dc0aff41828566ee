#!/bin/bash
# Measures and reports run time and error of the inverse dynamics beside other libraries.
set -euo pipefail

usage() {
  cat <<END
Usage: scripts/report.sh [--quick] [--no-install] [--output FOLDER]

Installs what is needed, builds in build/benchmark (without ROS), measures, and writes into FOLDER
  report.md            results with plots, to be read first
  estimator.md         error of efforts from estimated motions
  closed_loops.md      mechanisms with closed loops
  work_precision.csv, closed_loops.csv, leave_out.csv, estimator.csv, instructions.csv,
  generated_size.csv
                       the measurements
Nothing else should run on the machine meanwhile.
  --quick       fewer and shorter rounds, no more than 20 closed loops, and no count of instructions:
                takes about a minute once everything is built
  --no-install  do not install packages first
  --output      where to write (report/ in this repository)
END
}

repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
install=true
quick=()
output=$repository/report
while [[ $# -gt 0 ]]; do
  case "$1" in
    --quick) quick=(--quick) ;;
    --no-install) install=false ;;
    --output)
      [[ -n "${2:-}" ]] || { echo "report.sh: --output needs a folder" >&2; exit 2; }
      output=$2
      shift ;;
    -h | --help) usage; exit 0 ;;
    *) echo "report.sh: unknown option $1" >&2; usage >&2; exit 2 ;;
  esac
  shift
done
mkdir -p "$output"
output=$(realpath "$output")
cd "$repository"
counted_scenes=(six_axis_arm seven_axis_arm chain_100)
program=report.sh
steps=8
source scripts/measuring.sh
read -r load _ </proc/loadavg

end_well report.sh "measurements that are complete are in $output"
prepare "$install"
announce "Building in ${build#"$repository"/}, output in ${log#"$repository"/} ..."
build_programs work_precision leave_out estimator_error callgrind_sample inverse_dynamics_offline

# measure PROGRAM RESULT [OPTION]...: leaves RESULT in the output folder.
measure() {
  rm -f "$output/$2"
  run "$build/benchmark/$1" "${quick[@]}" --output "$output/$2" "${@:3}"
}

announce "Run time and error beside other libraries"
disagreement=false
rm -f "$output/closed_loops.csv"
measure work_precision work_precision.csv || disagreement=true
if [[ ! -f "$output/work_precision.csv" ]]; then
  echo "report.sh: work_precision has failed" >&2
  exit 1
fi
temporary+=("$output/closed_loops.csv.part" "$output/instructions.csv.part"
  "$output/generated_size.csv.part")
"$build/benchmark/work_precision" "${quick[@]}" --list-loops >"$output/closed_loops.csv.part"
mv "$output/closed_loops.csv.part" "$output/closed_loops.csv"
announce "What leaving out saves"
measure leave_out leave_out.csv
announce "Error of efforts from estimated motions"
recording=()
if [[ -d ../shared/recordings ]]; then recording=(--recording ../shared/recordings); fi
measure estimator_error estimator.csv "${recording[@]}"
run /usr/bin/python3 benchmark/report/estimator_page.py "$output"
rm -f "$output/instructions.csv"
if [[ ${#quick[@]} -gt 0 ]]; then
  announce "Instructions per sample: not counted in a quick run"
elif ! command -v valgrind >/dev/null; then
  announce "Instructions per sample: not counted, there is no valgrind"
else
  announce "Instructions per sample, of ${counted_scenes[*]}"
  run scripts/count_instructions.sh --program "$build/benchmark/callgrind_sample" \
    "${counted_scenes[@]}" >"$output/instructions.csv.part"
  mv "$output/instructions.csv.part" "$output/instructions.csv"
fi
announce "Size of generated code"
sized=(six_axis_arm seven_axis_arm chain_10)
for robot in ur5 tiago_no_hand hyq; do
  if "$build/benchmark/work_precision" --description "$robot" >/dev/null 2>&1; then sized+=("$robot"); fi
done
run scripts/generated_size.sh --tool "$build/inverse_dynamics_offline" \
  --program "$build/benchmark/work_precision" "${sized[@]}" >"$output/generated_size.csv.part"
mv "$output/generated_size.csv.part" "$output/generated_size.csv"
announce "Plots and tables"
run /usr/bin/python3 benchmark/report/closed_loops_page.py "$output"
run /usr/bin/python3 benchmark/report/report.py "${quick[@]}" --build "$build" --load "$load" "$output"
announce "Done."
if $disagreement; then
  echo "report.sh: a contender disagrees with the reference or failed; it is named above, and not" \
    "in the report" >&2
  exit 1
fi
