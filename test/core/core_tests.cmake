# core_tests, and sanitized_core_tests: the same tests of a library and an offline tool that are
# compiled with the address and undefined-behaviour sanitizers. Compiling the tests takes longest, and
# the sanitizers need not see their own code: they are compiled once and linked to both. So are the
# kernels of vector instructions: fenced arrays watch over what they read and write.

include(test/core/core_test_files.cmake)
include(test/core/real_113.cmake)
vwd_joined_tests(core_test_files ${core_test_files})
vwd_add_objects(core_test_objects OBJECT ${core_test_files})
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

# --- with sanitizers -------------------------------------------------------------------------------
set(sanitizers "-fsanitize=address,undefined -fno-sanitize-recover=all")
set(sanitized_library ${PROJECT_NAME}_sanitized)
set(sanitized_tool offline_tool_of_sanitized_tests)  # what has "test" in its name is not installed
add_library(${sanitized_library} SHARED ${core_files})
add_executable(${sanitized_tool} src/inverse_dynamics_offline_main.cpp ${offline_files})
vwd_link_core(${sanitized_library} ${sanitized_tool})
vwd_join(${sanitized_library})
vwd_join(${sanitized_tool})
add_executable(sanitized_core_tests ${core_test_files_of_build} ${core_test_objects})
target_compile_definitions(sanitized_core_tests PRIVATE VWD_SANITIZED)
target_include_directories(sanitized_core_tests PRIVATE src test/core)
target_link_libraries(sanitized_core_tests
  ${sanitized_library} ${PROJECT_NAME}_warnings ${gtest_libraries})
finish_core_tests(sanitized_core_tests ${sanitized_tool})
# Warnings are the other build's: GCC sees uninitialized variables in what the sanitizers add.
separate_arguments(sanitized_options UNIX_COMMAND
  "-O1 -g1 -UNDEBUG -fno-omit-frame-pointer -w ${sanitizers}")
# Null pointers and places outside of objects the address sanitizer finds, too, and addresses that are
# not aligned the processor: these checks at every access cost half of the time of compiling.
list(APPEND sanitized_options -fno-sanitize=null,alignment,object-size)
# Tests free what the library allocates: with sanitizers, Eigen would allocate in another way.
list(APPEND sanitized_options -DEIGEN_MALLOC_ALREADY_ALIGNED=1)
foreach(target ${sanitized_library} ${sanitized_tool} sanitized_core_tests)
  target_compile_options(${target} PRIVATE ${sanitized_options})
  set_target_properties(${target} PROPERTIES
    EXCLUDE_FROM_ALL TRUE
    LINK_FLAGS "${sanitizers}"
    LIBRARY_OUTPUT_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/sanitized
    RUNTIME_OUTPUT_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/sanitized)
endforeach()
# The library is to call its own copies of inline functions, not those that the tests have too.
set_target_properties(${sanitized_library} PROPERTIES
  LINK_FLAGS "${sanitizers} -Wl,-Bsymbolic-functions")
