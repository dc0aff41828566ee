# core_tests. What is compiled once for it and for sanitized_core_tests are objects.

include(test/core/core_test_files.cmake)
include(test/core/real_113.cmake)
vwd_joined_tests(core_test_files ${core_test_files})
vwd_add_objects(core_test_objects OBJECT ${core_test_files})
target_compile_options(core_test_objects PRIVATE -O1)  # they take longest to compile
set(core_test_objects $<TARGET_OBJECTS:core_test_objects> $<TARGET_OBJECTS:core_oracles>
  $<TARGET_OBJECTS:stability_scenes>)
# finish_core_tests(<target> <tool>)
function(finish_core_tests target tool)
  target_compile_definitions(${target} PRIVATE OFFLINE_TOOL="$<TARGET_FILE:${tool}>"
    VWD_SOURCE_DIR="${CMAKE_CURRENT_SOURCE_DIR}" VWD_SHARED_DATA="${VWD_SHARED_DATA}")
  target_compile_options(${target} PRIVATE ${checks_of_containers})
  target_link_libraries(${target} ${VWD_REAL113_LIBRARIES})
  add_dependencies(${target} ${tool})
endfunction()

vwd_add_gtest(core_tests ${core_test_files_of_build} ${core_test_objects})
if(NOT TARGET core_tests)
  return()
endif()
finish_core_tests(core_tests inverse_dynamics_offline)

# For sanitized_core_tests, which Clang builds elsewhere.
file(GENERATE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/core_test_objects.txt
  CONTENT "$<JOIN:${core_test_objects},\n>\n")
