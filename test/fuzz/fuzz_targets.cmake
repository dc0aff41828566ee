# Fuzz targets, one for each reader and one for the whole offline tool: see scripts/fuzz.sh, which runs
# them.

# vwd_add_fuzz_target(<name> <more sources>...)
function(vwd_add_fuzz_target name)
  add_executable(${name}_fuzz EXCLUDE_FROM_ALL test/fuzz/${name}_fuzz.cpp ${ARGN})
  target_compile_definitions(${name}_fuzz PRIVATE VWD_SOURCE_DIR="${CMAKE_CURRENT_SOURCE_DIR}")
  target_compile_options(${name}_fuzz PRIVATE ${guided_options})
  target_include_directories(${name}_fuzz PRIVATE test/fuzz src)
  target_link_libraries(${name}_fuzz PRIVATE ${sanitized_core} Threads::Threads
    ${PROJECT_NAME}_warnings -fsanitize=fuzzer,${sanitizers})
endfunction()

vwd_add_fuzz_target(description)
vwd_add_fuzz_target(scene)
vwd_add_fuzz_target(motion)
vwd_add_fuzz_target(bag ${bag_files} src/offline/joint_renaming.cpp src/offline/joint_state_rows.cpp)
target_link_libraries(bag_fuzz PRIVATE ${PROJECT_NAME}_compression)
vwd_add_fuzz_target(npz ${npz_files} src/offline/npz_motion.cpp)
vwd_add_fuzz_target(tool ${offline_files})
vwd_link_core(${sanitized_core} tool_fuzz)

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
