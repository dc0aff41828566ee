# sanitized_core_tests: core_tests with the library and the offline tool compiled with sanitizers. Compiling
# the tests takes longest, and the sanitizers need not see their own code: they are linked as they were
# compiled for core_tests. So are the kernels of vector instructions: fenced arrays watch over what they
# read and write.
include(test/core/core_test_files.cmake)
file(STRINGS ${VWD_CORE_TEST_OBJECTS} core_test_objects)
find_library(VWD_QUADMATH quadmath HINTS ${CMAKE_CXX_IMPLICIT_LINK_DIRECTORIES})

set(sanitized_tool offline_tool_of_sanitized_tests)  # what has "test" in its name is not installed
add_executable(${sanitized_tool} EXCLUDE_FROM_ALL
  src/inverse_dynamics_offline_main.cpp ${offline_files})
vwd_link_core(${sanitized_core} ${sanitized_tool})
vwd_join(${sanitized_tool})

add_executable(sanitized_core_tests EXCLUDE_FROM_ALL ${core_test_files_of_build})
target_compile_definitions(sanitized_core_tests PRIVATE VWD_SANITIZED
  OFFLINE_TOOL="$<TARGET_FILE:${sanitized_tool}>" VWD_SOURCE_DIR="${CMAKE_CURRENT_SOURCE_DIR}"
  VWD_SHARED_DATA="${VWD_SHARED_DATA}")
target_include_directories(sanitized_core_tests PRIVATE src test/core)
target_link_libraries(sanitized_core_tests PRIVATE ${core_test_objects} ${sanitized_core}
  ${gtest_libraries} Threads::Threads $<$<BOOL:${VWD_QUADMATH}>:${VWD_QUADMATH}>)
add_dependencies(sanitized_core_tests ${sanitized_tool})
foreach(target ${sanitized_tool} sanitized_core_tests)
  target_compile_options(${target} PRIVATE ${sanitized_options})
  target_link_options(${target} PRIVATE -fsanitize=${sanitizers})
endforeach()
