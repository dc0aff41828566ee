#!/bin/bash
# Measures latency, endurance and highest rate of inverse_dynamics_node through ROS.
set -euo pipefail

usage() {
  cat <<END
Usage: scripts/measure_ros.sh [--latency [SECONDS [RATE]]] [--endurance [SECONDS [RATE]]]
                              [--highest-rate [SECONDS]] [--robot URDF] [--real-time]
                              [--no-install] [--workspace FOLDER]

Measures the package through ROS, and prints the numbers, also to output/measure_ros.txt. Makes all
three measurements unless some are chosen. Nothing else should run on the machine meanwhile.
  --latency       time from publishing a joint state to receiving ~effort, compared with a node that
                  only copies the joint state and is sent to in turn (20 s at 1000 Hz each)
  --endurance     with all outputs subscribed and recorded by rosbag: whether anything is lost, results
                  more than 1 ms after their receipt, compared with the copying node, CPU share and
                  memory (60 s at 1000 Hz)
  --highest-rate  highest rate at which nothing is lost with all outputs recorded, SECONDS for each
                  rate (5 s)
  --robot         description of the robot (the reference data's TIAGo beside the repository, or else
                  urdf/six_axis_arm.urdf)
  --real-time     run the measured nodes before everything else on the machine (chrt --fifo 10; root):
                  tells their own share of latencies from the time in which they wait for a core
  --no-install    do not install packages first
  --workspace     a catkin workspace in which the package is built already, with
                  -DVWD_BUILD_BENCHMARKS=ON; otherwise it is built in build/.catkin_ws
Uses a ROS master of its own. The bags, up to gigabytes, are in TMPDIR and are removed at the end.
END
}

install=true
workspace=
arguments=()
while [[ $# -gt 0 ]]; do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    --no-install) install=false ;;
    --workspace)
      [[ $# -ge 2 ]] || { echo "measure_ros.sh: --workspace needs a folder" >&2; exit 2; }
      workspace=$(realpath "$2")
      shift ;;
    *) arguments+=("$1") ;;
  esac
  shift
done

repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
source "$repository/scripts/running.sh"
end_well measure_ros.sh "nothing was measured"
if $install; then "$repository/scripts/install_dependencies.sh" --run; fi
if [[ -z "$workspace" ]]; then
  run "$repository/scripts/build.sh" -DVWD_BUILD_BENCHMARKS=ON
  workspace=$repository/build/.catkin_ws
fi
if [[ ! -x "$workspace/devel/lib/virtual_work_dynamics/latency_probe" ]]; then
  echo "measure_ros.sh: $workspace was not built with -DVWD_BUILD_BENCHMARKS=ON" >&2
  exit 1
fi

export PATH=/usr/bin:$PATH PYTHONDONTWRITEBYTECODE=1
set +u  # ROS's setup files use variables that may be unset
source "$workspace/devel/setup.bash"
set -u
exec /usr/bin/python3 "$repository/benchmark/ros/measure_ros.py" \
  --programs "$workspace/devel/lib/virtual_work_dynamics" "${arguments[@]}"
