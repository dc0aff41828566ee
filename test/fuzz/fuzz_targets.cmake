# Fuzz targets, one for each reader and one for the whole offline tool: see scripts/fuzz.sh, which
# configures with Clang and runs them. The core that they call is compiled for them, with what guides
# the fuzzer and with the sanitizers; the kernels of vector instructions are those of the other builds.
if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  message(FATAL_ERROR "VWD_BUILD_FUZZERS needs Clang, the compiler is ${CMAKE_CXX_COMPILER_ID}")
endif()

set(fuzz_sanitizers "address,undefined,float-cast-overflow")
set(fuzz_options -O1 -g1 -UNDEBUG -D_GLIBCXX_ASSERTIONS -fno-omit-frame-pointer
  -fsanitize=${fuzz_sanitizers} -fno-sanitize-recover=all
  # As for sanitized_core_tests: what the address sanitizer finds, too, costs time of compiling.
  -fno-sanitize=null,alignment,object-size
  # As for sanitized_core_tests: objects with and without sanitizers free each other's memory.
  -DEIGEN_MALLOC_ALREADY_ALIGNED=1)
set(fuzzed_library ${PROJECT_NAME}_fuzzed)
add_library(${fuzzed_library} STATIC EXCLUDE_FROM_ALL ${core_files})
vwd_join(${fuzzed_library})
target_compile_options(${fuzzed_library} PRIVATE ${fuzz_options} -fsanitize=fuzzer-no-link)

# vwd_add_fuzz_target(<name> <more sources>...)
function(vwd_add_fuzz_target name)
  add_executable(${name}_fuzz EXCLUDE_FROM_ALL test/fuzz/${name}_fuzz.cpp ${ARGN})
  target_compile_definitions(${name}_fuzz PRIVATE VWD_SOURCE_DIR="${CMAKE_CURRENT_SOURCE_DIR}")
  target_compile_options(${name}_fuzz PRIVATE ${fuzz_options} -fsanitize=fuzzer-no-link)
  target_include_directories(${name}_fuzz PRIVATE test/fuzz src)
  target_link_libraries(${name}_fuzz PRIVATE ${fuzzed_library} Threads::Threads
    ${PROJECT_NAME}_warnings -fsanitize=fuzzer,${fuzz_sanitizers})
endfunction()

vwd_add_fuzz_target(description)
vwd_add_fuzz_target(scene)
vwd_add_fuzz_target(motion)
vwd_add_fuzz_target(bag ${bag_files} src/offline/joint_renaming.cpp src/offline/joint_state_rows.cpp)
target_link_libraries(bag_fuzz PRIVATE ${PROJECT_NAME}_compression)
vwd_add_fuzz_target(tool ${offline_files})
vwd_link_core(${fuzzed_library} tool_fuzz)

# Messages need headers and a library of ROS, but neither catkin nor a master.
find_path(VWD_ROS_MESSAGES_DIR trajectory_msgs/JointTrajectory.h)
find_library(VWD_ROS_TIME rostime)
if(VWD_ROS_MESSAGES_DIR AND VWD_ROS_TIME)
  vwd_add_fuzz_target(messages
    src/ros/fixed_frames.cpp
    src/ros/free_joint_conversion.cpp
    src/ros/free_joints.cpp
    src/ros/imu_conversion.cpp
    src/ros/joint_state_conversion.cpp
    src/ros/pose_reading.cpp
    src/ros/root_conversion.cpp
    src/ros/sample_times.cpp
    src/ros/trajectory_conversion.cpp
    src/ros/trajectory_samples.cpp
    src/ros/wrench_conversion.cpp)
  target_include_directories(messages_fuzz SYSTEM PRIVATE ${VWD_ROS_MESSAGES_DIR})
  target_link_libraries(messages_fuzz PRIVATE ${VWD_ROS_TIME})
endif()
