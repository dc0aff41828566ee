#!/bin/bash
# Builds and tests the package on another release, in a chroot of its own.
set -euo pipefail

usage() {
  cat <<END
Usage: scripts/test_on.sh [OPTION]... bullseye|bookworm|trixie

Makes a minimal system of Debian 11, 12 or 13 with debootstrap, copies this repository into it (what
git tracks and what is not committed yet, not what it ignores), and there runs
  scripts/install_dependencies.sh --test --demo
  scripts/test.sh --portable --no-install    the build with warnings as errors, unit and ROS tests
  scripts/demo.sh --no-install
Checks that need tools of Debian 12 are left out. ../shared, if it is there, is copied too: without
it, the tests of reference results are skipped. Prints versions, and in the last line the verdict.
Logs and results are left in build/test_on/RELEASE/. Exit status 0 if everything passed, 1 if
something failed, 2 if the command is wrong. Needs root, debootstrap and 5 GB of disk. JOBS is how many
processes compile.
  --compiler COMPILER  what to compile with, as g++-9 (which Debian 11 has); its package is installed
  --folder FOLDER      make the system in a new folder in this one (TMPDIR)
  --keep               do not remove the system at the end, and say where it is
  --mirror URL         Debian's archive, instead of the one that apt is configured with here
  --timeout MINUTES    fail when everything together takes longer (180)
END
}

# fail STATUS MESSAGE...
fail() {
  local status=$1
  shift
  echo "test_on.sh: $*" >&2
  exit "$status"
}

suite=
compiler=
folder=
keep=false
mirror=
minutes=180
while [[ $# -gt 0 ]]; do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    --keep) keep=true ;;
    --compiler | --folder | --mirror | --timeout)
      [[ -n "${2:-}" ]] || fail 2 "$1 needs a value"
      case "$1" in
        --compiler) compiler=$2 ;;
        --folder) folder=$2 ;;
        --mirror) mirror=$2 ;;
        --timeout) minutes=$2 ;;
      esac
      shift ;;
    bullseye | bookworm | trixie)
      [[ -z "$suite" ]] || fail 2 "one release at a time, not $suite and $1"
      suite=$1 ;;
    *) fail 2 "unknown option or release '$1'; --help names all" ;;
  esac
  shift
done
[[ -n "$suite" ]] || fail 2 "which release? bullseye, bookworm or trixie"
[[ "$minutes" =~ ^[1-9][0-9]*$ ]] || fail 2 "--timeout: '$minutes' is not a positive number"
[[ -z "$compiler" || "$compiler" =~ ^g\+\+-[0-9]+$ ]] ||
  fail 2 "--compiler: '$compiler' is not g++ with its version, as g++-9"
[[ $(id -u) -eq 0 ]] || fail 2 "needs root, to make a chroot"
for tool in debootstrap git unshare; do
  command -v "$tool" >/dev/null || fail 2 "$tool is missing"
done

repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$repository"
git=(git -c "safe.directory=*")
"${git[@]}" rev-parse --git-dir >/dev/null 2>&1 || fail 2 "$repository is not a git repository"

# Apt itself reads every style of its sources; archives of security updates have no whole system.
if [[ -z "$mirror" ]]; then
  mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 2>/dev/null |
    grep -E '/debian/?$' | head -n 1) || true
  [[ -n "$mirror" ]] || fail 2 "apt is configured with no archive of Debian here; see --mirror"
fi

folder=${folder:-${TMPDIR:-/tmp}}
mkdir -p "$folder"
work=$(mktemp -d "$(realpath "$folder")/test_on_$suite.XXXXXXXX")
chmod 755 "$work"  # apt reads as another user
root=$work/system
inside=/src/virtual_work_dynamics
logs=$repository/build/test_on/$suite
deadline=$((SECONDS + 60 * minutes))

running=
told=false  # where the system is
clean_up() {
  if [[ -n "$running" ]]; then
    kill -KILL "$running" 2>/dev/null || true
    wait "$running" 2>/dev/null || true
  fi
  if $keep; then
    $told || echo "test_on.sh: kept $root"
    return
  fi
  # What was killed may take a moment to be gone.
  for _ in 1 2 3 4 5; do
    rm -rf --one-file-system "$work" 2>/dev/null && return
    sleep 1
  done
  echo "test_on.sh: could not remove $work" >&2
}
trap clean_up EXIT
trap 'exit 130' INT
trap 'exit 143' TERM HUP

# contained COMMAND...: runs it until the deadline. Its processes and what it mounts are in namespaces
# that end with it or, killed, with this script: nothing is left to be ended or unmounted.
contained() {
  local left=$((deadline - SECONDS)) status=0
  ((left > 0)) || return 124
  set -m  # otherwise programs in there would not hear SIGINT, by which roslaunch ends them
  # Bash comes first, since it collects the orphans that its namespace leaves to it.
  unshare --mount --pid --fork --kill-child --mount-proc bash -c '
    if [[ -d "$2/proc" ]]; then mount -t proc proc "$2/proc" || exit; fi
    timeout --kill-after=10 "$1" "${@:3}"
    exit $?' bash "$left" "$root" "$@" </dev/null &
  running=$!
  set +m
  wait "$running" || status=$?
  running=
  return "$status"
}

environment=(PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 "JOBS=${JOBS:-$(nproc)}")
for name in http_proxy https_proxy no_proxy; do
  [[ -z "${!name:-}" ]] || environment+=("$name=${!name}")
done
if [[ -n "$compiler" ]]; then environment+=("CXX=$compiler" "CC=gcc-${compiler#g++-}"); fi

# in_system COMMAND...: runs it in the copy of the repository, in the system.
in_system() {
  contained chroot "$root" /usr/bin/env -i "${environment[@]}" \
    /bin/bash -c 'cd "$1" && shift && exec "$@"' bash "$inside" "$@"
}

make_system() {
  local options=(--variant=minbase)
  [[ "$mirror" != https:* ]] || options+=(--include=ca-certificates)
  contained debootstrap "${options[@]}" "$suite" "$root" "$mirror" >"$logs/debootstrap.log" 2>&1 || {
    local status=$?
    tail -n 20 "$logs/debootstrap.log" >&2
    return "$status"
  }
  cp -L /etc/hosts /etc/resolv.conf "$root/etc"
}

copy_repository() {
  mkdir -p "$root$inside"
  "${git[@]}" ls-files -z --cached --others --exclude-standard |
    while IFS= read -r -d '' file; do
      if [[ -e "$file" || -L "$file" ]]; then printf '%s\0' "$file"; fi
    done | tar --create --null --no-recursion --files-from=- | tar --extract -C "$root$inside" || return
  if [[ -d ../shared ]]; then cp -rL ../shared "$root${inside%/*}/shared"; fi
}

install_compiler() {
  in_system env DEBIAN_FRONTEND=noninteractive bash -c '
    apt-get -qq update && apt-get -qq install -y --no-install-recommends "$1"' bash "$compiler" \
    >"$logs/compiler.log" 2>&1 || {
    local status=$?
    tail -n 20 "$logs/compiler.log" >&2
    return "$status"
  }
}

print_versions() {
  in_system bash -c '
    . /etc/os-release
    echo "  system   $PRETTY_NAME, $(uname -m)"
    echo "  gcc      $("${CXX:-g++}" --version | head -n 1)"
    echo "  glibc    $(ldd --version | head -n 1)"
    dpkg-query --show --showformat="  \${Package} \${Version}\n" cmake libeigen3-dev liburdfdom-dev \
      liburdfdom-headers-dev libyaml-cpp-dev libgtest-dev libroscpp-dev catkin python3'
}

save_logs() {
  local build=$root$inside/build
  cp "$build"/*.log "$logs" 2>/dev/null || true
  cp -r "$build/test_results" "$logs" 2>/dev/null || true
  cp -r "$build/.catkin_ws/build/test_results" "$logs/test_results_of_catkin" 2>/dev/null || true
}

failed=()
stage=0
# run STAGE COMMAND...: announces it, and notes by name whether it failed.
run() {
  local name=$1 status=0
  shift
  stage=$((stage + 1))
  echo "[$stage/$stages] $name ($SECONDS s)"
  "$@" || status=$?
  [[ "$status" -ne 0 ]] || return 0
  if ((SECONDS >= deadline)); then name+=" (beyond $minutes minutes)"; fi
  echo "test_on.sh: failed: $name" >&2
  failed+=("$name")
  return 1
}

# finish: the verdict, in the last line.
finish() {
  local what=$suite${compiler:+ with $compiler}
  save_logs
  echo "Logs: ${logs#"$repository"/}"
  if $keep; then echo "Kept: $root; enter it with: chroot $root"; fi
  told=true
  if [[ ${#failed[@]} -eq 0 ]]; then
    echo "test_on.sh: $what: passed in $SECONDS s, exit status 0"
    exit 0
  fi
  local names
  printf -v names '%s, ' "${failed[@]}"
  echo "test_on.sh: $what: FAILED: ${names%, }, after $SECONDS s, exit status 1"
  exit 1
}

rm -rf "$logs"
mkdir -p "$logs"
stages=6
[[ -n "$compiler" ]] && stages=7
run "debootstrap $suite from $mirror" make_system || finish
run "copy of the repository" copy_repository || finish
if [[ ! -d ../shared ]]; then echo "No ../shared: tests of reference results are skipped."; fi
if [[ -n "$compiler" ]]; then run "installing $compiler" install_compiler || finish; fi
run "scripts/install_dependencies.sh --test --demo" \
  in_system scripts/install_dependencies.sh --test --demo || finish
run "versions" print_versions || finish
echo "Not run, for they are checks of Debian 12: format, lint, sanitizers, measurements."
run "scripts/test.sh --portable --no-install" \
  in_system scripts/test.sh --portable --no-install || true
run "scripts/demo.sh --no-install" in_system scripts/demo.sh --no-install || true
finish
