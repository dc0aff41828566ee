# Functions for the scripts that measure, which source this file in the repository after they have set
# program (the script's name) and steps (how many it announces).
build=$PWD/build/benchmark
log=$PWD/build/benchmark.log
source scripts/running.sh
export PATH=/usr/bin:$PATH PYTHONDONTWRITEBYTECODE=1

step=0
announce() {
  step=$((step + 1))
  echo "[$step/$steps] $* ($SECONDS s)"
}

# prepare INSTALL: installs packages if INSTALL is true, and checks for matplotlib.
prepare() {
  if $1; then scripts/install_dependencies.sh --build --benchmark; fi
  /usr/bin/python3 -c 'import matplotlib' 2>/dev/null || {
    echo "$program: Python's matplotlib is missing (Debian, Ubuntu: python3-matplotlib)" >&2
    exit 1
  }
}

# build_programs TARGET...: builds programs without ROS into $build/benchmark.
build_programs() {
  mkdir -p "$build"
  if ! run build_into_log "$@"; then
    grep -E -A 5 'error|Error' "$log" | head -n 40 >&2 || tail -n 40 "$log" >&2
    echo "$program: the build failed; its whole output is in $log" >&2
    exit 1
  fi
}
build_into_log() {
  {
    cmake -S . -B "$build" -DCMAKE_BUILD_TYPE=Release -DVWD_CORE_ONLY=ON -DVWD_BUILD_BENCHMARKS=ON \
      -DBUILD_TESTING=OFF && cmake --build "$build" --target "$@" -- -j"${JOBS:-$(nproc)}"
  } 2>&1 | tee "$log" | show_build_progress
}
