vwd_core(
  assembly.cpp
  closed_loop_dynamics.cpp
  closed_loop_workspace.cpp
  closure_conditions.cpp
  compared_length.cpp
  completion.cpp
  completion_positions.cpp
  completion_rates.cpp
  condition.cpp
  condition_sizes.cpp
  coupling_conditions.cpp
  cut_tree.cpp
  cylinder_conditions.cpp
  driven_conditions.cpp
  force_choice.cpp
  force_ranges.cpp
  forces.cpp
  gear_conditions.cpp
  given_loops.cpp
  groups.cpp
  holds.cpp
  kernel/baseline.cpp
  kernel/loop_kernel_choice.cpp
  kinematics.cpp
  link_kinematics.cpp
  loop_fit.cpp
  loop_rows.cpp
  nearest_closing.cpp
  pack_choice.cpp
  packed_rows.cpp
  point_springs.cpp
  rank.cpp
  reactions.cpp
  residuals.cpp
  sample_pack.cpp
  spring_reach.cpp
  tooth_forces.cpp
  touch_conditions.cpp
  unborne_loads.cpp
  unknowns.cpp
  zero_rows.cpp)

vwd_core_vectors(
  kernel/avx2.cpp
  kernel/avx512.cpp)

# As the kernels of the recursion, see tree/sources.cmake.
set(loop_flags "-ffp-contract=off -Wno-psabi")
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(loop_flags "${loop_flags} -Wno-maybe-uninitialized")
endif()
set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/kernel/baseline.cpp
  PROPERTIES COMPILE_FLAGS "${loop_flags}" SKIP_PRECOMPILE_HEADERS ON)
if(VWD_X86)
  set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/kernel/avx2.cpp
    PROPERTIES COMPILE_FLAGS "${loop_flags} -mavx2 -mfma")
  set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/kernel/avx512.cpp
    PROPERTIES COMPILE_FLAGS "${loop_flags} -mavx2 -mfma -mavx512f -mavx512dq")
endif()
