vwd_core(
  cone_corners.cpp
  cone_program.cpp
  elimination_order.cpp
  front_layout.cpp
  kernel/baseline.cpp
  kernel/front_kernel_choice.cpp
  least_norms.cpp
  multifrontal_qr.cpp
  rank_factorization.cpp)

vwd_core_vectors(
  kernel/avx2.cpp
  kernel/avx512.cpp)

# As the kernels of the recursion, see tree/sources.cmake.
set(front_flags "-ffp-contract=off -Wno-psabi")
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(front_flags "${front_flags} -Wno-maybe-uninitialized")
endif()
set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/kernel/baseline.cpp
  PROPERTIES COMPILE_FLAGS "${front_flags}" SKIP_PRECOMPILE_HEADERS ON)
if(VWD_X86)
  set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/kernel/avx2.cpp
    PROPERTIES COMPILE_FLAGS "${front_flags} -mavx2 -mfma")
  set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/kernel/avx512.cpp
    PROPERTIES COMPILE_FLAGS "${front_flags} -mavx2 -mfma -mavx512f -mavx512dq")
endif()
