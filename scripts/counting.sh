# Functions for the scripts that count and measure with one program, which source this file after they
# have set program (the script's name) and repository.
export PATH=/usr/bin:$PATH

# need COMMAND: ends where the command is missing.
need() {
  if ! command -v "$1" >/dev/null; then
    echo "$program: $1 is missing; see scripts/install_dependencies.sh --benchmark" >&2
    exit 1
  fi
}

# built TARGET: prints the path of a program of build/benchmark that is built now, without ROS.
built() {
  local build=$repository/build/benchmark log
  log=$(mktemp)
  if ! { cmake -S "$repository" -B "$build" -DVWD_CORE_ONLY=ON -DVWD_BUILD_BENCHMARKS=ON \
           -DBUILD_TESTING=OFF && cmake --build "$build" --target "$1" -- \
           -j"${JOBS:-$(nproc)}"; } >"$log" 2>&1; then
    tail -n 40 "$log" >&2
    rm -f "$log"
    echo "$program: building failed" >&2
    return 1
  fi
  rm -f "$log"
  find "$build" -name "$1" -type f -perm -u+x -print -quit
}

# counted_by COMMAND...: runs a program under callgrind, its output into $work/output, and prints how
# many instructions its function countedRun took, or a clone of it that the compiler made.
counted_by() {
  local instructions
  if ! valgrind --tool=callgrind --callgrind-out-file=/dev/null --collect-atstart=no \
      --toggle-collect='countedRun*' "$@" 2>"$work/valgrind.log" >"$work/output" </dev/null; then
    tail -n 20 "$work/valgrind.log" >&2
    return 1
  fi
  instructions=$(sed -n 's/^.*Collected : \([0-9]*\)$/\1/p' "$work/valgrind.log")
  if [[ -z "$instructions" || "$instructions" == 0 ]]; then
    echo "$program: valgrind counted nothing" >&2
    return 1
  fi
  echo "$instructions"
}
