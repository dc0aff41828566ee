#!/bin/bash
# Makes a Debian package of the whole: nodes, launch files, offline tool, core and its headers.
set -euo pipefail

usage() {
  cat <<END_OF_USAGE
Usage: scripts/make_deb.sh [CMAKE_ARGUMENT ...]

Builds with the prefix /usr in build/deb, and makes the package of it; the last line is its name. Its
files lie where those of Debian's own ROS packages do. It depends on the libraries that its programs
are linked to and on what the launch files run. Install it with: sudo apt install ./NAME
Needs what scripts/install_dependencies.sh installs, and works where that does.
END_OF_USAGE
}
if [[ "${1:-}" == -h || "${1:-}" == --help ]]; then
  usage
  exit 0
fi

repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
folder=$repository/build/deb
build=$folder/build
export PATH=/usr/bin:$PATH
unset CMAKE_PREFIX_PATH  # no package of a workspace, but those of the system

mkdir -p "$folder"
cmake -S "$repository" -B "$build" -DCMAKE_INSTALL_PREFIX=/usr -DCMAKE_BUILD_TYPE=Release \
  -DCATKIN_BUILD_BINARY_PACKAGE=ON -DCATKIN_ENABLE_TESTING=OFF \
  -DPYTHON_EXECUTABLE=/usr/bin/python3 -DPython3_EXECUTABLE=/usr/bin/python3 "$@"
cmake --build "$build" -- -j"${JOBS:-$(nproc)}"

version=$(sed -n 's|.*<version>\(.*\)</version>.*|\1|p' "$repository/package.xml")
maintainer=$(sed -n 's|.*<maintainer email="\(.*\)">\(.*\)</maintainer>.*|\2 <\1>|p' "$repository/package.xml")
dependencies=$repository/scripts/install_dependencies.sh
run_packages=$(comm -13 <("$dependencies" --list) <("$dependencies" --run --list) |
  paste --serial --delimiters=, | sed 's/,/, /g')

# CPack asks dpkg-shlibdeps for the libraries, and writes what makes ldconfig know ours.
cat >"$folder/CPackConfig.cmake" <<END_OF_CONFIG
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_DIRECTORY "$folder")
set(CPACK_PACKAGE_NAME ros-virtual-work-dynamics)
set(CPACK_PACKAGE_VERSION "$version")
set(CPACK_PACKAGE_FILE_NAME ros-virtual-work-dynamics)
set(CPACK_PACKAGE_CONTACT "$maintainer")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Robot OS inverse dynamics with reactions of all joints")
set(CPACK_PACKAGE_DESCRIPTION
"Active efforts and the 6-D reaction wrench at every joint of a mechanism, in
real time, from a URDF and joint states or trajectories. Nodes, launch files,
an offline tool, and a C++ library with its headers, which include those of
Eigen and yaml-cpp.")
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "$run_packages")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "catkin, libeigen3-dev, libyaml-cpp-dev, python3-matplotlib, python3-scipy, rviz, snakemake")
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS
  "$(dirname "$(find "$build/devel" -name 'libvirtual_work_dynamics.so')")")
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_CMAKE_GENERATOR "Unix Makefiles")
set(CPACK_INSTALL_CMAKE_PROJECTS "$build;virtual_work_dynamics;ALL;/")
set(CPACK_INSTALLED_DIRECTORIES
  "$folder/doc;/usr/share/doc/ros-virtual-work-dynamics")
END_OF_CONFIG
mkdir -p "$folder/doc"
cp "$repository/LICENSE" "$folder/doc/copyright"
rm -f "$folder"/*.deb
(cd "$folder" && cpack --config CPackConfig.cmake)
echo "$folder"/*.deb
