# For scripts that build with sanitizers, see test/sanitized.cmake; after setting $repository.
sanitized_build=$repository/build/sanitized

# build_sanitized TARGET...: with Clang, one job for each processor or $JOBS. The first of the scripts
# compiles the core for the others, whatever options it gave in $sanitized_options.
build_sanitized() {
  local compiler
  compiler=$(command -v clang++-14 || command -v clang++) || {
    echo "clang++ is missing; see scripts/install_dependencies.sh --checks" >&2
    return 1
  }
  cmake -S "$repository" -B "$sanitized_build" -DCMAKE_CXX_COMPILER="$compiler" \
    -DCMAKE_BUILD_TYPE=Release -DVWD_CORE_ONLY=ON -DBUILD_TESTING=OFF -DVWD_BUILD_SANITIZED=ON \
    "${sanitized_options[@]}" &&
    cmake --build "$sanitized_build" --target "$@" -- -j"${JOBS:-$(nproc)}"
}
