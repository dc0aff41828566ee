#!/bin/bash
# Builds the package in a catkin workspace of its own.
set -euo pipefail

usage() {
  cat <<END
Usage: scripts/build.sh [CATKIN_MAKE_ARGUMENT ...]

Builds in build/.catkin_ws with the system's Python; arguments go to catkin_make, for example
-DVWD_WARNINGS_AS_ERRORS=ON, or the name of a target. Leaves out the tests, which need more packages,
unless -DCATKIN_ENABLE_TESTING=ON is given. The whole output is in build/build.log.
To use the build: source build/setup.bash
END
}
if [[ "${1:-}" == -h || "${1:-}" == --help ]]; then
  usage
  exit 0
fi

repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# The workspace is hidden, as ROS looks for launch files by walking through a package, links included,
# and would walk in circles through the workspace's link to this package. It leaves hidden folders out.
workspace=$repository/build/.catkin_ws
log=$repository/build/build.log

# ROS's Python packages need the system's interpreter, but another python3 may come first in PATH.
export PATH=/usr/bin:$PATH

mkdir -p "$workspace/src"
ln -sfn "$repository" "$workspace/src/virtual_work_dynamics"
echo "source '$workspace/devel/setup.bash'" >"$repository/build/setup.bash"

source "$repository/scripts/running.sh"

build_into_log() {
  catkin_make --directory "$workspace" -j"${JOBS:-$(nproc)}" --no-color \
    -DPYTHON_EXECUTABLE=/usr/bin/python3 -DPython3_EXECUTABLE=/usr/bin/python3 \
    -DCMAKE_BUILD_TYPE=Release -DCATKIN_ENABLE_TESTING=OFF "$@" 2>&1 | tee "$log" | show_build_progress
}

start=$SECONDS
echo "Building ..."
end_well build.sh "the next build goes on from there"
if ! run build_into_log "$@"; then
  grep -E -A 5 'error|Error' "$log" | head -n 40 >&2 || tail -n 40 "$log" >&2
  echo "build.sh: failed; the whole output is in $log" >&2
  exit 1
fi
grep -E -A 3 'warning:' "$log" || true
echo "Built in $((SECONDS - start)) s."
