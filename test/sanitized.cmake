# Everything that runs with the address and undefined-behaviour sanitizers: the fuzz targets, one for each
# reader and one for the whole offline tool, and sanitized_core_tests, the core's tests. Compiling takes
# longest: the core is compiled once for all of them, with Clang, as the fuzzer needs, and the tests, whose
# own code the sanitizers need not see, are those that the other build has compiled. The kernels of vector
# instructions have no sanitizers; fenced arrays watch over what they read and write.
# See scripts/fuzz.sh and scripts/test.sh, which configure with Clang.
if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  message(FATAL_ERROR "VWD_BUILD_SANITIZED needs Clang, the compiler is ${CMAKE_CXX_COMPILER_ID}")
endif()

set(sanitizers "address,undefined,float-cast-overflow")
set(sanitized_options -O1 -g1 -UNDEBUG -D_GLIBCXX_ASSERTIONS -fno-omit-frame-pointer
  -fsanitize=${sanitizers} -fno-sanitize-recover=all -fsanitize=fuzzer-no-link
  # Objects with and without sanitizers free each other's memory: Eigen is to allocate in one way.
  -DEIGEN_MALLOC_ALREADY_ALIGNED=1)
set(sanitized_library ${PROJECT_NAME}_sanitized)
add_library(${sanitized_library} SHARED EXCLUDE_FROM_ALL ${core_files})
add_library(sanitized_offline OBJECT EXCLUDE_FROM_ALL ${offline_files})
vwd_link_core(${sanitized_library} sanitized_offline)
target_compile_options(${sanitized_library} PRIVATE ${sanitized_options})
target_compile_options(sanitized_offline PRIVATE ${sanitized_options})
# The library is to call its own copies of inline functions, not those that the tests have too.
set_target_properties(${sanitized_library} PROPERTIES LINK_FLAGS "-Wl,-Bsymbolic-functions")
# vwd_add_sanitized(<name> <runtime> <sources>...)
function(vwd_add_sanitized name runtime)
  add_executable(${name} EXCLUDE_FROM_ALL ${ARGN})
  target_compile_definitions(${name} PRIVATE
    VWD_SOURCE_DIR="${CMAKE_CURRENT_SOURCE_DIR}" VWD_VERSION="${VWD_VERSION}")
  target_compile_options(${name} PRIVATE ${sanitized_options})
  target_include_directories(${name} PRIVATE src)
  target_link_libraries(${name} PRIVATE ${sanitized_library} Threads::Threads
    ${PROJECT_NAME}_warnings -fsanitize=${runtime})
endfunction()

# --- the core's tests ------------------------------------------------------------------------------
set(VWD_CORE_TEST_OBJECTS "" CACHE FILEPATH
  "The archive core_test_objects of the build that has compiled the tests")
if(VWD_CORE_TEST_OBJECTS)
  include(test/core/core_test_files.cmake)
  include(test/core/real_113.cmake)
  vwd_add_sanitized(sanitized_offline_tool ${sanitizers}
    src/inverse_dynamics_offline_main.cpp $<TARGET_OBJECTS:sanitized_offline>)
  vwd_add_sanitized(sanitized_core_tests ${sanitizers} ${core_test_files_of_build})
  target_include_directories(sanitized_core_tests PRIVATE test/core)
  target_compile_definitions(sanitized_core_tests PRIVATE VWD_SANITIZED
    OFFLINE_TOOL="$<TARGET_FILE:sanitized_offline_tool>" VWD_SHARED_DATA="${VWD_SHARED_DATA}")
  target_link_libraries(sanitized_core_tests PRIVATE
    -Wl,--whole-archive ${VWD_CORE_TEST_OBJECTS} -Wl,--no-whole-archive
    ${gtest_libraries} ${VWD_REAL113_LIBRARIES})
  set_property(TARGET sanitized_core_tests APPEND PROPERTY LINK_DEPENDS ${VWD_CORE_TEST_OBJECTS})
  add_dependencies(sanitized_core_tests sanitized_offline_tool)
endif()

# --- fuzz targets ----------------------------------------------------------------------------------
# vwd_add_fuzz_target(<name> <more sources>...)
function(vwd_add_fuzz_target name)
  vwd_add_sanitized(${name}_fuzz fuzzer,${sanitizers} test/fuzz/${name}_fuzz.cpp ${ARGN})
  target_include_directories(${name}_fuzz PRIVATE test/fuzz)
endfunction()

vwd_add_fuzz_target(description)
vwd_add_fuzz_target(scene)
vwd_add_fuzz_target(motion)
vwd_add_fuzz_target(tool $<TARGET_OBJECTS:sanitized_offline>)

# Messages need headers and a library of ROS, but neither catkin nor a master.
find_path(VWD_ROS_MESSAGES_DIR trajectory_msgs/JointTrajectory.h)
find_library(VWD_ROS_TIME rostime)
if(VWD_ROS_MESSAGES_DIR AND VWD_ROS_TIME)
  vwd_add_fuzz_target(messages
    src/ros/joint_state_conversion.cpp
    src/ros/root_conversion.cpp
    src/ros/sample_times.cpp
    src/ros/trajectory_conversion.cpp
    src/ros/trajectory_samples.cpp
    src/ros/wrench_conversion.cpp)
  target_include_directories(messages_fuzz SYSTEM PRIVATE ${VWD_ROS_MESSAGES_DIR})
  target_link_libraries(messages_fuzz PRIVATE ${VWD_ROS_TIME})
endif()
