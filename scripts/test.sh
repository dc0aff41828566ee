#!/bin/bash
# Installs, builds and checks everything. The last line is "N passed, N failed".
set -euo pipefail

usage() {
  cat <<END
Usage: scripts/test.sh [--portable] [--no-install]

Builds with warnings as errors and runs: unit tests, tests through ROS, the core's tests under the
address and undefined-behaviour sanitizers, the measurements' agreement with other libraries, users
of the installed core and of the catkin package, ten seconds of fuzzing for each reader, the numbered
examples, the format check, the rules of the folders, tests of scripts and guides, pages of the headers
without a warning, catkin_lint, and checks that the core library links nothing of ROS and that code
compiled for special instructions cannot serve elsewhere. Each check counts like a test. Results are in
build/test_results/. Works on Debian 12.
  --portable    only what needs no tools of Debian 12: builds with warnings as errors, without the
                measurements, and runs the unit tests and the tests through ROS
  --no-install  do not install packages first
END
}

install=true
portable=false
for argument in "$@"; do
  case "$argument" in
    --no-install) install=false ;;
    --portable) portable=true ;;
    -h | --help) usage; exit 0 ;;
    *) echo "test.sh: unknown option $argument" >&2; usage >&2; exit 2 ;;
  esac
done

repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$repository"
workspace=$repository/build/.catkin_ws
results=$repository/build/test_results
package_build=$workspace/build/virtual_work_dynamics

export PATH=/usr/bin:$PATH
export ROS_HOSTNAME=localhost ROS_HOME=$repository/build/ros_home
rm -rf "$results" "$workspace/build/test_results"
mkdir -p "$results" "$ROS_HOME"

# check NAME COMMAND...: runs a command and files its verdict as one more test.
check() {
  local name=$1 log=$results/$1.log start=$SECONDS verdict=ok
  shift
  "$@" >"$log" 2>&1 </dev/null || verdict=FAILED
  {
    echo "<testsuite name=\"checks\"><testcase classname=\"checks\" name=\"$name\">"
    [[ $verdict == ok ]] || echo "<failure message=\"see ${log#"$repository"/}\"/>"
    echo "</testcase></testsuite>"
  } >"$results/$name.xml"
  printf '%-6s  %s (%d s)\n' "$verdict" "$name" $((SECONDS - start))
  [[ $verdict == ok ]] || { tail -n 30 "$log"; return 1; }
}

build() {
  local all=ON
  if $portable; then all=OFF; fi
  local options=(-DVWD_WARNINGS_AS_ERRORS=ON -DCATKIN_ENABLE_TESTING=ON
    "-DVWD_PRECOMPILE_HEADERS=$all" "-DVWD_JOIN_SOURCES=$all" "-DVWD_BUILD_BENCHMARKS=$all")
  scripts/build.sh "${options[@]}" && scripts/build.sh "${options[@]}" tests
}

# Two at once: tests through ROS mostly wait, each under a master of its own. The exit code says nothing
# about the tests. Not by catkin_make, which would configure anew in the midst of the other build.
run_tests() {
  cmake --build "$workspace/build" --target run_tests -- -j2
}

sanitized_targets=(sanitized_core_tests {description,scene,motion,bag,npz,messages,tool}_fuzz)
shards=8

# sanitized_shards: runs those shards of the sanitized tests that nobody has taken. Without the tests that
# measure how accurate motions and kernels are, which take long and run no other code than the rest.
sanitized_shards() {
  local shard failed=false
  for ((shard = 0; shard < shards; ++shard)); do
    mkdir "$results/shards/$shard" 2>/dev/null || continue
    (cd build/sanitized && GTEST_TOTAL_SHARDS=$shards GTEST_SHARD_INDEX=$shard \
      UBSAN_OPTIONS=print_stacktrace=1 ./sanitized_core_tests --gtest_filter='-*Accuracy.*' \
      --gtest_output="xml:$results/sanitized_core_tests.junit/core_tests_$shard.xml") || failed=true
  done
  ! $failed
}

# Builds with sanitizers, and runs the tests, while tests through ROS run, which leave most of the processor
# free. What is left then is done by all processors.
start_sanitized() {
  mkdir -p "$results/shards"
  set -m  # a process group of its own, to be ended as a whole
  (renice -n 19 -p "$BASHPID" && JOBS=1 scripts/sanitized_build.sh "${sanitized_targets[@]}" &&
    touch "$results/shards/built" && sanitized_shards) \
    >"$results/started_sanitized.log" 2>&1 </dev/null &
  started=$!
  set +m
}
stop_sanitized() {
  [[ -n "${started:-}" ]] || return 0
  kill -- "-$started" 2>/dev/null || true
  wait "$started" 2>/dev/null || true
  while kill -0 -- "-$started" 2>/dev/null; do sleep 0.1; done
  rm -rf "$results/shards"  # what it had taken is to be run
  mkdir -p "$results/shards"
  started=
}
sanitized_core_tests() {
  local worker workers=() failed=false
  if [[ -e "$results/shards/built" ]]; then
    renice -n 0 -g "$started" || true  # only the superuser may
    workers+=("$started")
  else
    stop_sanitized
    scripts/sanitized_build.sh "${sanitized_targets[@]}" || return 1
    sanitized_shards &
    workers+=($!)
  fi
  sanitized_shards || failed=true
  for worker in "${workers[@]}"; do wait "$worker" || failed=true; done
  started=
  cat "$results/started_sanitized.log"
  worker=$(find "$results/sanitized_core_tests.junit" -name '*.xml' | wc -l)
  [[ $worker -eq $shards ]] || { echo "$worker of $shards shards have run"; failed=true; }
  ! $failed
}

# Each target starts from what is known to be hard, and from what earlier runs on this machine learnt; with
# the same changes each time, so that what fails has to do with what was changed.
fuzz() {
  scripts/fuzz.sh --seconds 10 --seed 1
}

# Every contender of a scene is compared with the reference before it is timed.
contenders_agree() {
  local scenes=(--scene pendulum --scene six_axis_arm --scene chain_10 --scene four_bar
    --scene spatial_parallelogram)
  "$workspace/devel/lib/virtual_work_dynamics/work_precision" --quick --rounds 1 "${scenes[@]}" \
    --output "$results/work_precision.csv"
}

format() {
  command -v clang-format-14 >/dev/null || { echo "clang-format-14 is missing"; return 1; }
  find include src test benchmark examples -name '*.h' -o -name '*.cpp' | sort |
    xargs clang-format-14 --dry-run -Werror
}

core_links_no_ros() {
  local library=$workspace/devel/lib/libvirtual_work_dynamics.so needed
  needed=$(readelf --dynamic --wide "$library" | grep NEEDED) || return 1
  echo "$needed"
  ! grep -E -i 'ros|xmlrpc|catkin' <<<"$needed"
}

# Refuses weak and unique symbols in kernels, as the linker may take such symbols from any object.
kernels_share_no_code() {
  local objects
  mapfile -t objects < <(find "$package_build"/CMakeFiles/virtual_work_dynamics{,_vectors}.dir \
    -path '*/kernel/*.o' -not -name '*kernel_choice*' -o -path '*witness/momentum/avx2*.o')
  [[ ${#objects[@]} -ge 10 ]] || { echo "only ${#objects[@]} objects of kernels"; return 1; }
  printf '%s\n' "${objects[@]}"
  ! nm --demangle "${objects[@]}" | grep -E '^[0-9a-f]+ [WVu] '
}

# Every warning is an error, see doc/Doxyfile.
doxygen_pages() {
  mkdir -p build
  doxygen doc/Doxyfile
}

# What the numbered examples print, against formulas of the test's own.
examples() {
  PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 test/examples/examples_test.py "$package_build/examples"
}

scripts_tests() {
  local test
  for test in test/scripts/*_test.py; do
    PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 "$test" || return 1
  done
}

# Ignores find_package(catkin) behind an option, which counts as out of order; scripts, which are run
# from the repository; include folders of dependencies; and urdfdom, which package.xml has by its
# rosdep name, liburdfdom-dev.
lint() {
  local missing
  missing=$(catkin_lint --quiet -W0 . 2>&1 | grep -E 'missing [a-z_]*depend' | grep -v "'urdfdom'")
  echo "$missing"
  [[ -z "$missing" ]] &&
    catkin_lint -W1 --strict --ignore catkin_order_violation --ignore order_violation \
      --ignore missing_depend --ignore uninstalled_script --ignore external_interface_path .
}

# print_verdict: every failure by name, and the line of numbers.
print_verdict() {
  mkdir -p "$workspace/build/test_results"
  scripts/count_tests.py "$results" "$workspace/build/test_results"
}

if $portable; then
  if $install; then scripts/install_dependencies.sh --test; fi
  if check build_without_warnings build; then check run_tests run_tests || true; fi
  print_verdict
  exit
fi

if $install; then scripts/install_dependencies.sh --checks; fi
if check build_without_warnings build; then
  start_sanitized
  trap stop_sanitized EXIT
  check run_tests run_tests || true
  check core_links_no_ros core_links_no_ros || true
  check kernels_share_no_code kernels_share_no_code || true
  check sanitized_core_tests sanitized_core_tests || true
  check scripts scripts_tests &  # takes one processor, as fuzzing does
  scripts_check=$!
  trap 'kill "$scripts_check" 2>/dev/null || true; stop_sanitized' EXIT
  check fuzz fuzz || true
  check contenders_agree contenders_agree || true
  check installs_core test/downstream/check.sh core || true
  check exports_devel_space test/downstream/check.sh devel || true
  check exports_install_space test/downstream/check.sh install || true
  check examples examples || true
  wait "$scripts_check" || true
  trap stop_sanitized EXIT
else
  check scripts scripts_tests || true
fi
check format format || true
check architecture scripts/architecture.py || true
check doxygen_pages doxygen_pages || true
check catkin_lint lint || true

print_verdict
