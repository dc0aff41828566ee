set(ros_files)
foreach(file
    active_plan.cpp
    closure_frames.cpp
    contact_frames.cpp
    contact_places.cpp
    counters.cpp
    cross_check.cpp
    described_robot.cpp
    determinacy_message.cpp
    deviation_output.cpp
    deviation_report.cpp
    diagnostics.cpp
    effort_measurements.cpp
    effort_output.cpp
    fixed_frames.cpp
    foreign_frames.cpp
    free_joint_conversion.cpp
    free_joints.cpp
    imu_conversion.cpp
    inverse_dynamics_node.cpp
    inverse_dynamics_parameters.cpp
    joint_state_computation.cpp
    joint_state_conversion.cpp
    joint_watch.cpp
    loop_record.cpp
    loop_report.cpp
    marker_output.cpp
    motion_completer.cpp
    node_program.cpp
    output_topics.cpp
    outputs.cpp
    plan_switch.cpp
    pose_reading.cpp
    position_watch.cpp
    private_name.cpp
    private_parameters.cpp
    residual_output.cpp
    robot_task.cpp
    root_conversion.cpp
    root_frames.cpp
    root_inputs.cpp
    root_messages.cpp
    root_publisher.cpp
    root_settings.cpp
    rviz_configuration.cpp
    rviz_for_robot.cpp
    sample_computation.cpp
    sample_times.cpp
    scene_inputs.cpp
    scene_parameter.cpp
    self_check_report.cpp
    start_position.cpp
    stream_record.cpp
    stream_report.cpp
    threshold_record.cpp
    threshold_report.cpp
    tf_record.cpp
    topic_names.cpp
    trajectory_computation.cpp
    trajectory_conversion.cpp
    trajectory_output.cpp
    trajectory_publisher.cpp
    trajectory_samples.cpp
    trajectory_settings.cpp
    wrench_conversion.cpp
    wrench_inputs.cpp
    xmlrpc_to_yaml.cpp)
  list(APPEND ros_files ${CMAKE_CURRENT_LIST_DIR}/${file})
endforeach()

# The template of rviz_for_robot is part of the program, which so needs no place to find it.
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
  ${PROJECT_SOURCE_DIR}/config/inverse_dynamics.rviz)
file(READ ${PROJECT_SOURCE_DIR}/config/inverse_dynamics.rviz VWD_RVIZ_TEMPLATE)
configure_file(${CMAKE_CURRENT_LIST_DIR}/rviz_template.cpp.in
  ${PROJECT_BINARY_DIR}/rviz_template.cpp @ONLY)
list(APPEND ros_files ${PROJECT_BINARY_DIR}/rviz_template.cpp)
