#!/bin/bash
# Runs the paper's composed pendulum through ROS and draws the paper's figures.
set -euo pipefail

usage() {
  cat <<END
Usage: scripts/demo.sh [--no-install]

Installs what is needed, builds, and runs the composed pendulum of Stroe and Staicu (2010) for its
six seconds, once from a joint trajectory and once live from joint states at 1 kHz. Writes
  output/composed_pendulum.bag    all inputs and outputs
  output/figures_3_to_6.png       Figures 3 to 6 of the paper: computed curves over the closed forms
and prints the largest errors and the run time per sample. Needs no screen, and uses a ROS master of
its own.
  --no-install  do not install packages first
END
}

install=true
for argument in "$@"; do
  case "$argument" in
    --no-install) install=false ;;
    -h | --help) usage; exit 0 ;;
    *) echo "demo.sh: unknown option $argument" >&2; usage >&2; exit 2 ;;
  esac
done

repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$repository"
output=$repository/output
bag=$output/composed_pendulum.bag
figure=$output/figures_3_to_6.png
log=$repository/build/demo.log

if $install; then scripts/install_dependencies.sh --demo; fi
scripts/build.sh

export PATH=/usr/bin:$PATH
set +u  # ROS's setup files use variables that may be unset
source build/setup.bash
set -u
export ROS_HOSTNAME=localhost ROS_HOME=$repository/build/ros_home
port=$(/usr/bin/python3 -c \
  'import socket; s = socket.socket(); s.bind(("localhost", 0)); print(s.getsockname()[1])')
export ROS_MASTER_URI=http://localhost:$port

launch=
stop() {
  [[ -z "$launch" ]] || kill "$launch" 2>/dev/null || true
  wait
}
trap stop EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

mkdir -p "$output" "$ROS_HOME"
rm -f "$bag" "$bag.active" "$figure"
echo "Running the composed pendulum for 6 s, from a trajectory and from joint states ..."
timeout 120 roslaunch --port "$port" virtual_work_dynamics demo.launch bag:="$bag" \
  >"$log" 2>&1 &
launch=$!
wait "$launch" || true  # the contents of the bag decide
launch=
if [[ ! -f "$bag" ]]; then
  tail -n 40 "$log" >&2
  echo "demo.sh: nothing was recorded; the whole output is in $log" >&2
  exit 1
fi

PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 scripts/plot_composed_pendulum.py "$bag" "$figure" || {
  echo "demo.sh: failed; the output of the nodes is in $log" >&2
  exit 1
}
echo
echo "Recorded: ${bag#"$repository"/}"
echo "Figures:  ${figure#"$repository"/}"
