# core_tests, and their objects, which test/sanitized.cmake links once more, to a library and an offline
# tool that are compiled with sanitizers.

include(test/core/core_test_files.cmake)
include(test/core/real_113.cmake)
vwd_add_objects(core_test_objects STATIC
  ${core_test_files} $<TARGET_OBJECTS:core_oracles> $<TARGET_OBJECTS:stability_scenes>)
# GCC 12 forgets that a precompiled header is the system's, and warns of strings there where it is wrong.
set_source_files_properties(
  test/core/dirty_faults.cpp test/core/instruction_set_test.cpp
  test/core/offline_certificates_test.cpp test/core/offline_plan_test.cpp
  PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
vwd_precompile(core_test_objects <Eigen/Core> <functional> <gtest/gtest.h> <string> <vector>)
set_target_properties(core_test_objects PROPERTIES ARCHIVE_OUTPUT_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR})
vwd_add_gtest(core_tests ${core_test_files_of_build} $<TARGET_OBJECTS:core_test_objects>
  $<TARGET_OBJECTS:core_oracles> $<TARGET_OBJECTS:stability_scenes>)
if(NOT TARGET core_tests)
  return()
endif()
add_dependencies(core_tests core_test_objects inverse_dynamics_offline)
target_compile_definitions(core_tests PRIVATE OFFLINE_TOOL="$<TARGET_FILE:inverse_dynamics_offline>"
  VWD_SOURCE_DIR="${CMAKE_CURRENT_SOURCE_DIR}" VWD_SHARED_DATA="${VWD_SHARED_DATA}")
target_compile_options(core_tests PRIVATE ${checks_of_containers})
target_link_libraries(core_tests ${VWD_REAL113_LIBRARIES})
