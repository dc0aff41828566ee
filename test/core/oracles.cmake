# What tests and measurements of stability judge by, compiled once for both: core_oracles, and
# stability_scenes.

# Instead of the sanitizers' checks, those of Eigen and the standard library; with which GCC 12 warns
# of strings that overlap, and is wrong.
set(checks_of_containers -UNDEBUG -D_GLIBCXX_ASSERTIONS)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  list(APPEND checks_of_containers -Wno-restrict)
endif()

# vwd_add_objects(<name> <type> <sources>...)
function(vwd_add_objects name type)
  add_library(${name} ${type} EXCLUDE_FROM_ALL ${ARGN})
  target_compile_options(${name} PRIVATE
    $<TARGET_PROPERTY:${PROJECT_NAME}_warnings,INTERFACE_COMPILE_OPTIONS> ${checks_of_containers})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src
    ${PROJECT_SOURCE_DIR}/test/core ${PROJECT_SOURCE_DIR}/benchmark)
  target_include_directories(${name} SYSTEM PRIVATE
    ${EIGEN3_INCLUDE_DIRS} ${YAML_CPP_INCLUDE_DIR} ${GTEST_INCLUDE_DIRS})
endfunction()

vwd_add_objects(core_oracles OBJECT
  test/core/four_bar.cpp
  test/core/lagrange_multipliers_oracle.cpp
  test/core/loop_geometry.cpp
  test/core/maximal_coordinates_freedoms.cpp
  test/core/maximal_coordinates_oracle.cpp
  test/core/newton_euler_oracle.cpp)
vwd_add_objects(stability_scenes OBJECT
  benchmark/stability/balance_sweeps.cpp
  benchmark/stability/body_sweeps.cpp
  benchmark/stability/exact_results.cpp
  benchmark/stability/four_bar_sweeps.cpp
  benchmark/stability/held_sweeps.cpp
  benchmark/stability/linkage_sweeps.cpp
  benchmark/stability/loop_judge.cpp
  benchmark/stability/loop_judge_holds.cpp
  benchmark/stability/loop_judge_loads.cpp
  benchmark/stability/loop_scenes.cpp
  benchmark/stability/mechanism_maker.cpp
  benchmark/stability/mixed_loops.cpp
  benchmark/stability/motion_sweeps.cpp
  benchmark/stability/structure_sweeps.cpp
  benchmark/stability/structured_loops.cpp
  benchmark/stability/sweeps.cpp
  benchmark/stability/touch_sweeps.cpp
  benchmark/stability/worst_certificates.cpp)
