#!/bin/bash
# Installs with apt what the package needs on Debian 11, 12 and 13. Ends quickly when everything is
# there.
set -euo pipefail

build_packages=(
  build-essential catkin cmake
  libbz2-dev libconsole-bridge-dev libeigen3-dev liblz4-dev libtinyxml2-dev liburdfdom-dev liburdfdom-headers-dev
  libyaml-cpp-dev
  libdiagnostic-msgs-dev libdiagnostic-updater-dev libgeometry-msgs-dev libnav-msgs-dev
  libroscpp-dev libsensor-msgs-dev libtf2-dev libtf2-msgs-dev libtrajectory-msgs-dev libvisualization-msgs-dev
  ros-environment
)
run_packages=(
  python3-rosbag python3-roslaunch python3-rostopic ros-robot-state-publisher rosbash rosout
  tf2-tools
  python3-diagnostic-msgs python3-geometry-msgs python3-sensor-msgs python3-trajectory-msgs
  python3-visualization-msgs
)
test_packages=(
  "${run_packages[@]}"
  libgtest-dev librostest-dev locales python3-nav-msgs python3-numpy python3-rostest
)
check_packages=(
  "${test_packages[@]}"
  binutils catkin-lint clang-14 clang-format-14 doxygen libbenchmark-dev libclang-rt-14-dev
  liborocos-kdl-dev python3-matplotlib python3-scipy python3-yaml
)
demo_packages=("${run_packages[@]}" python3-matplotlib)
rviz_packages=("${run_packages[@]}" rviz)
benchmark_packages=(
  libbenchmark-dev libdart-dev libmujoco-dev liborocos-kdl-dev python3-matplotlib valgrind
)

usage() {
  cat <<END
Usage: scripts/install_dependencies.sh [--build] [--run] [--test] [--checks] [--demo] [--rviz]
                                       [--benchmark] [--list]

Installs the packages needed to build (always), to run the launch files (--run), to run the unit and
ROS tests (--test), to run every check of scripts/test.sh (--checks, on Debian 12 only), to run the
demo (--demo), to show robots in RViz (--rviz) and to build the measurements and the libraries they
compare with (--benchmark).
  --list  only print the names of the packages
Works on Debian 11, 12 and 13, whose archives have ROS 1 and the same names of packages. On Ubuntu
20.04 with ROS Noetic, let rosdep do it:
  rosdep install --from-paths . --ignore-src
END
}

wanted=("${build_packages[@]}")
list=false
for argument in "$@"; do
  case "$argument" in
    --build) ;;
    --run) wanted+=("${run_packages[@]}") ;;
    --test) wanted+=("${test_packages[@]}") ;;
    --checks) wanted+=("${check_packages[@]}") ;;
    --demo) wanted+=("${demo_packages[@]}") ;;
    --rviz) wanted+=("${rviz_packages[@]}") ;;
    --benchmark) wanted+=("${benchmark_packages[@]}") ;;
    --list) list=true ;;
    -h | --help) usage; exit 0 ;;
    *) echo "install_dependencies.sh: unknown option $argument" >&2; usage >&2; exit 2 ;;
  esac
done
mapfile -t wanted < <(printf '%s\n' "${wanted[@]}" | sort -u)

if $list; then
  printf '%s\n' "${wanted[@]}"
  exit 0
fi

system=$(. /etc/os-release 2>/dev/null && echo "${ID:-unknown} ${VERSION_ID:-}" || echo unknown)
if [[ ! "$system" =~ ^debian\ (11|12|13)$ ]]; then
  cat >&2 <<END
install_dependencies.sh: this is '$system', and the list of packages is for Debian 11, 12 and 13.
On Ubuntu 20.04 with ROS Noetic, in this folder:
  rosdep install --from-paths . --ignore-src
and then build as any catkin package, or call the other scripts with --no-install.
END
  exit 1
fi

missing=()
for package in "${wanted[@]}"; do
  status=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null || true)
  [[ "$status" == installed ]] || missing+=("$package")
done
if [[ ${#missing[@]} -eq 0 ]]; then
  echo "All ${#wanted[@]} packages are installed."
  exit 0
fi

as_root=()
if [[ $(id -u) -ne 0 ]]; then
  command -v sudo >/dev/null || {
    echo "install_dependencies.sh: needs root or sudo to install: ${missing[*]}" >&2
    exit 1
  }
  as_root=(sudo)
fi

echo "Installing ${#missing[@]} packages: ${missing[*]}"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
apt() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq "$@" >"$log" 2>&1 || {
    tail -n 20 "$log" >&2
    echo "install_dependencies.sh: 'apt-get $1' failed" >&2
    exit 1
  }
}
apt update
absent=()
for package in "${missing[@]}"; do
  [[ -n "$(apt-cache madison "$package" 2>/dev/null)" ]] || absent+=("$package")
done
if [[ ${#absent[@]} -gt 0 ]]; then
  echo "install_dependencies.sh: '$system' has no package ${absent[*]}" >&2
  exit 1
fi
apt install -y --no-install-recommends "${missing[@]}"
echo "Installed."
