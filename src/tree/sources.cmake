vwd_core(
  applied_values.cpp
  block.cpp
  inverse_dynamics.cpp
  kernel/baseline.cpp
  kernel/kernel_choice.cpp
  plan.cpp
  plan_counting.cpp
  plan_reduction.cpp
  plan_rounding.cpp
  sample_block.cpp)

vwd_core_vectors(
  kernel/avx2.cpp
  kernel/avx512.cpp)

# The recursion fuses multiply-adds where it says so and nowhere else. GCC's note on how vectors are
# passed concerns functions that are all inlined; its warning of uninitialized variables, its own
# AVX-512 intrinsics (GCC bug 105593).
set(kernel_flags "-ffp-contract=off -Wno-psabi")
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(kernel_flags "${kernel_flags} -Wno-maybe-uninitialized")
endif()
set_source_files_properties(
  ${CMAKE_CURRENT_LIST_DIR}/kernel/baseline.cpp ${CMAKE_CURRENT_LIST_DIR}/plan_counting.cpp
  PROPERTIES COMPILE_FLAGS "${kernel_flags}" SKIP_PRECOMPILE_HEADERS ON)
# It counts operations of the kernels' own code, which the sanitizers see in kernel/baseline.cpp; with
# them GCC 12 takes minutes for it.
set_property(SOURCE ${CMAKE_CURRENT_LIST_DIR}/plan_counting.cpp
  APPEND_STRING PROPERTY COMPILE_FLAGS " -fno-sanitize=all")
if(VWD_X86)
  # GCC gathers numbers of one sample into vectors, which takes longer than it saves: without, a sample
  # takes 0 to 11 % less in the build for AVX-512, 1 to 5 % less with reactions in that for AVX2. Without,
  # clang takes up to 2.5 % more instructions.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    set(vector_flags "-fno-tree-slp-vectorize")
  endif()
  set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/kernel/avx2.cpp
    PROPERTIES COMPILE_FLAGS "${kernel_flags} ${vector_flags} -mavx2 -mfma")
  set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/kernel/avx512.cpp
    PROPERTIES COMPILE_FLAGS "${kernel_flags} ${vector_flags} -mavx2 -mfma -mavx512f -mavx512dq")
endif()
