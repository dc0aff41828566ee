#!/bin/bash
# Installs the package and builds users of it, each in one of three ways.
set -euo pipefail

usage() {
  cat <<END_OF_USAGE
Usage: test/downstream/check.sh core|devel|install

core     installs the core without ROS, moves it, and builds and runs test/downstream/core with it;
         takes object files from the workspace of scripts/build.sh where they are there
devel    builds and runs test/downstream/catkin with the devel space of scripts/build.sh
install  the same with an install space, which it installs
What is installed must hold nothing private: other headers than those of include/, libraries that
public headers do not include, flags of warnings, folders of this machine. Works in build/downstream.
END_OF_USAGE
}

repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
workspace=$repository/build/.catkin_ws
folder=$repository/build/downstream/${1:-}
python=(-DPYTHON_EXECUTABLE=/usr/bin/python3 -DPython3_EXECUTABLE=/usr/bin/python3)

fail() {
  echo "check.sh: $*" >&2
  exit 1
}

# nothing_private PREFIX: what is installed there, except for the environment of a catkin workspace.
nothing_private() {
  local prefix=$1 file
  local private='urdfdom|tinyxml2|console_bridge|roscpp|_ros\b|pthread|threads|[ "]-W|_warnings|/src\b'
  (cd "$repository/include" && find . -type f | sort) >"$folder/public"
  (cd "$prefix/include" && find . -type f | sort) | diff "$folder/public" - ||
    fail "other headers than those of include/"
  find "$prefix" -name '*.cmake' >"$folder/exported"
  while read -r file; do
    if sed -e 's/#.*//' -e "s|$prefix||g" "$file" | grep -i -E "$private"; then
      fail "private things in $file"
    fi
  done <"$folder/exported"
  # The programs that measure, which -DVWD_BUILD_BENCHMARKS=ON installs, read files of the repository.
  find "$prefix" -mindepth 2 -type f >"$folder/installed_files"
  find "$workspace/build/virtual_work_dynamics/benchmark/CMakeFiles" -maxdepth 1 -name '*.dir' \
    -printf '/%f\n' 2>/dev/null | sed 's/\.dir$/$/' >"$folder/programs_that_measure" || true
  grep -v -f "$folder/programs_that_measure" "$folder/installed_files" >"$folder/files_of_users"
  while read -r file; do
    # The Config.cmake that catkin makes names the folder it is installed to. Counted: a pipe whose
    # reader leaves at the first match fails.
    if LC_ALL=C sed "s|$prefix||g" "$file" |
        grep --text -c -F -e "$repository" -e "$(realpath -m "$workspace")" >"$folder/count"; then
      fail "a folder of this machine in $file"
    fi
  done <"$folder/files_of_users"
}

# user_of PREFIX SOURCE: configured, built and run; finds nothing but that.
user_of() {
  local prefix=$1 source=$2 build=$folder/user log=$folder/configure.log
  CMAKE_PREFIX_PATH=$prefix${CMAKE_PREFIX_PATH:+:$CMAKE_PREFIX_PATH} \
    cmake -S "$source" -B "$build" "${python[@]}" >"$log" 2>&1 || { cat "$log"; fail "not configured"; }
  grep -F "virtual_work_dynamics of $prefix/" "$log" || fail "another than that of $prefix is found"
  cmake --build "$build"
}

# run_below FOLDER PROGRAM ARGUMENT...
run_below() {
  local program
  program=$(find "$1" -type f -name "$2" -perm -u+x)
  echo "${program:?no $2 in $1}"
  "$program" "${@:3}"
}

# generated: code follows the description that it is generated from. 2 kg more of rod_2, whose centre of
# mass is 0.875 m from joint_1, take 2 * 0.875^2 N m more per rad/s^2.
generated() {
  local first second urdf=$folder/user/generated.urdf
  first=$(run_below "$folder/user" downstream_of_generated | tail -n 1)
  sed 's/<mass value="1"/<mass value="3"/' "$urdf" >"$folder/heavier"
  cat "$folder/heavier" >"$urdf"
  cmake --build "$folder/user"
  second=$(run_below "$folder/user" downstream_of_generated | tail -n 1)
  echo "efforts by generated code: $first; with 2 kg more: $second"
  awk -v first="$first" -v second="$second" 'BEGIN { split(first, a); split(second, b);
    more = b[2] - a[2] - 1.53125; exit !(a[2] > 0.1 && more < 2e-9 && more > -2e-9) }' ||
    fail "the generated code does not follow its description"
}

core() {
  local build=$folder/build prefix=$folder/installed moved=$folder/elsewhere/moved version
  cmake -S "$repository" -B "$build" -DVWD_CORE_ONLY=ON -DBUILD_TESTING=OFF -DVWD_JOIN_SOURCES=ON \
    -DCMAKE_INSTALL_PREFIX="$prefix" \
    "-DCMAKE_CXX_COMPILER_LAUNCHER=$repository/test/downstream/reuse_object.sh;$workspace/build/virtual_work_dynamics"
  cmake --build "$build" --target install -- -j"${JOBS:-$(nproc)}"
  nothing_private "$prefix"
  mkdir "$folder/elsewhere"
  mv "$prefix" "$moved"
  rm -r "$build"
  user_of "$moved" "$repository/test/downstream/core"
  run_below "$folder/user" downstream "$repository/urdf/composed_pendulum.urdf"
  generated
  version=$(sed -n 's|.*<version>\(.*\)</version>.*|\1|p' "$repository/package.xml")
  [[ $("$moved/bin/inverse_dynamics_offline" --version) == "inverse_dynamics_offline $version" ]]
}

# catkin_user PREFIX
catkin_user() {
  user_of "$1" "$repository/test/downstream/catkin"
  run_below "$folder/user" downstream "$repository/urdf/composed_pendulum.urdf"
  run_below "$folder/user" downstream_by_target
  generated
}

devel() {
  catkin_user "$workspace/devel"
}

# Not by building the target `install`, which would build all the rest before.
install() {
  rm -rf "$workspace/install"
  cmake -P "$workspace/build/cmake_install.cmake"
  nothing_private "$workspace/install"
  catkin_user "$workspace/install"
}

case "${1:-}" in
  core | devel | install) ;;
  -h | --help) usage; exit 0 ;;
  *) usage >&2; exit 2 ;;
esac
rm -rf "$folder"
mkdir -p "$folder"
"$1"
