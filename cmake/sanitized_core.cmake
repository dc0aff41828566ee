# The core compiled with Clang's address and undefined-behaviour sanitizers and with what guides libFuzzer,
# once for the fuzz targets and for sanitized_core_tests; the kernels of vector instructions are those of
# the other builds. scripts/sanitized_build.sh configures it.
if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  message(FATAL_ERROR "VWD_BUILD_SANITIZED needs Clang, the compiler is ${CMAKE_CXX_COMPILER_ID}")
endif()

set(sanitizers "address,undefined,float-cast-overflow")
set(sanitized_options -O1 -g1 -UNDEBUG -D_GLIBCXX_ASSERTIONS -fno-omit-frame-pointer
  -fsanitize=${sanitizers} -fno-sanitize-recover=all
  # Null pointers and places outside of objects the address sanitizer finds, too, and addresses that are
  # not aligned the processor: these checks at every access cost half of the time of compiling.
  -fno-sanitize=null,alignment,object-size
  # Objects with and without sanitizers free each other's memory: with sanitizers, Eigen would allocate
  # in another way.
  -DEIGEN_MALLOC_ALREADY_ALIGNED=1)
set(guided_options ${sanitized_options} -fsanitize=fuzzer-no-link)

set(sanitized_core ${PROJECT_NAME}_sanitized)
add_library(${sanitized_core} SHARED EXCLUDE_FROM_ALL ${core_files})
vwd_join(${sanitized_core})
target_compile_options(${sanitized_core} PRIVATE ${guided_options})
# It is to call its own copies of inline functions, not those that tests without sanitizers have, too.
target_link_options(${sanitized_core} PRIVATE -fsanitize=${sanitizers} -Wl,-Bsymbolic-functions)
