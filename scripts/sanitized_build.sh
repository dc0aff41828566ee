#!/bin/bash
# Builds fuzz targets and tests with sanitizers.
set -euo pipefail

usage() {
  cat <<END
Usage: scripts/sanitized_build.sh TARGET ...

Builds with Clang in build/sanitized, where the library is compiled with the address and
undefined-behaviour sanitizers and with what guides libFuzzer: fuzz targets (description_fuzz, ...; see
scripts/fuzz.sh) and sanitized_core_tests, which takes the tests as scripts/build.sh compiled them.
JOBS, a variable of the environment, is the number of compilers at once. The whole output is in
build/sanitized.log.
END
}
case "${1:-}" in
  -h | --help) usage; exit 0 ;;
  '') usage >&2; exit 2 ;;
esac

repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$repository"
build=$repository/build/sanitized
log=$repository/build/sanitized.log
tests=$repository/build/.catkin_ws/build/virtual_work_dynamics/core_test_objects.txt
source scripts/running.sh
end_well sanitized_build.sh "the next build goes on from there"

compiler=$(command -v clang++-14 || command -v clang++ || true)
if [[ -z "$compiler" ]]; then
  echo "sanitized_build.sh: clang++ is missing; see scripts/install_dependencies.sh --checks" >&2
  exit 1
fi
if [[ ! -f "$tests" ]]; then
  if [[ " $* " == *" sanitized_core_tests "* ]]; then
    echo "sanitized_build.sh: the tests are not compiled; see scripts/test.sh" >&2
    exit 1
  fi
  tests=
fi

build_targets() {
  {
    cmake -S . -B "$build" -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Release \
      -DVWD_CORE_ONLY=ON -DBUILD_TESTING=OFF -DVWD_BUILD_SANITIZED=ON -DVWD_JOIN_SOURCES=ON \
      "-DVWD_CORE_TEST_OBJECTS=$tests" &&
      cmake --build "$build" --target "$@" -- -j"${JOBS:-$(nproc)}"
  } 2>&1 | tee "$log" | show_build_progress
}
mkdir -p "$build"
start=$SECONDS
echo "Building $* with $compiler ..."
if ! run build_targets "$@"; then
  grep -E -A 5 'error|Error' "$log" | head -n 40 >&2 || tail -n 40 "$log" >&2
  echo "sanitized_build.sh: failed; the whole output is in $log" >&2
  exit 1
fi
echo "Built in $((SECONDS - start)) s."
