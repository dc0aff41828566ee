# core_tests, and sanitized_core_tests: the same tests of a library and an offline tool that are
# compiled with the address and undefined-behaviour sanitizers. Compiling the tests takes longest, and
# the sanitizers need not see their own code: they are compiled once and linked to both. So are the
# kernels of vector instructions: fenced arrays watch over what they read and write.

set(stability_scenes
  benchmark/stability/balance_sweeps.cpp
  benchmark/stability/body_sweeps.cpp
  benchmark/stability/exact_results.cpp
  benchmark/stability/four_bar_sweeps.cpp
  benchmark/stability/held_sweeps.cpp
  benchmark/stability/linkage_sweeps.cpp
  benchmark/stability/loop_judge.cpp
  benchmark/stability/loop_scenes.cpp
  benchmark/stability/mechanism_maker.cpp
  benchmark/stability/motion_sweeps.cpp
  benchmark/stability/structure_sweeps.cpp
  benchmark/stability/structured_loops.cpp
  benchmark/stability/sweeps.cpp
  benchmark/stability/worst_certificates.cpp)
set(core_test_files
  test/core/assembly_test.cpp
  test/core/axis_direction_test.cpp
  test/core/block_record_test.cpp
  test/core/block_test.cpp
  test/core/block_use_test.cpp
  test/core/certificates_test.cpp
  test/core/closed_loop_completion_test.cpp
  test/core/closed_loop_examples_test.cpp
  test/core/closed_loop_four_bar_test.cpp
  test/core/closed_loop_free_bodies_test.cpp
  test/core/closed_loop_lagrange_test.cpp
  test/core/closed_loop_outputs_test.cpp
  test/core/closed_loop_policies_test.cpp
  test/core/closed_loop_published_test.cpp
  test/core/closed_loop_random_test.cpp
  test/core/closed_loop_refusals_test.cpp
  test/core/closed_loop_singular_test.cpp
  test/core/closed_loop_tree_test.cpp
  test/core/description_deviations_test.cpp
  test/core/description_messages_test.cpp
  test/core/deviation_rows_test.cpp
  test/core/deviations_test.cpp
  test/core/dirty_descriptions.cpp
  test/core/dirty_descriptions_test.cpp
  test/core/dirty_faults.cpp
  test/core/dirty_text_faults.cpp
  test/core/dynamics_test.cpp
  test/core/dynamics_use_test.cpp
  test/core/effort_doubts_test.cpp
  test/core/error_bound_test.cpp
  test/core/existence_test.cpp
  test/core/given_motions_test.cpp
  test/core/instruction_set_test.cpp
  test/core/inverse_dynamics_test.cpp
  test/core/joint_terms_test.cpp
  test/core/kernel_accuracy_test.cpp
  test/core/lagrange_dynamics_test.cpp
  test/core/lagrange_load_test.cpp
  test/core/live_wrenches_test.cpp
  test/core/loop_conditions_test.cpp
  test/core/loop_kinematics_test.cpp
  test/core/loop_moment_points_test.cpp
  test/core/loop_oracles_test.cpp
  test/core/loop_rank_test.cpp
  test/core/loop_residuals_test.cpp
  test/core/model_view_test.cpp
  test/core/moment_points_test.cpp
  test/core/motion_completion_accuracy_test.cpp
  test/core/motion_completion_test.cpp
  test/core/motion_csv_test.cpp
  test/core/motion_estimator_jumps_test.cpp
  test/core/motion_estimator_rules_test.cpp
  test/core/motion_estimator_start_test.cpp
  test/core/motion_estimator_streams_test.cpp
  test/core/motion_estimator_test.cpp
  test/core/motion_law_test.cpp
  test/core/moving_root_motions_test.cpp
  test/core/moving_root_test.cpp
  test/core/multifrontal_qr_test.cpp
  test/core/nearest_name_test.cpp
  test/core/non_holonomic_conditions_test.cpp
  test/core/offline_certificates_test.cpp
  test/core/offline_deviations_test.cpp
  test/core/offline_errors_test.cpp
  test/core/offline_loops_checks_test.cpp
  test/core/offline_given_test.cpp
  test/core/offline_inputs_test.cpp
  test/core/offline_loops_errors_test.cpp
  test/core/offline_loops_test.cpp
  test/core/offline_loops_threads_test.cpp
  test/core/offline_names_test.cpp
  test/core/offline_plan_test.cpp
  test/core/offline_recordings_test.cpp
  test/core/offline_root_test.cpp
  test/core/offline_test.cpp
  test/core/offline_wrapped_test.cpp
  test/core/offline_wrenches_test.cpp
  test/core/passive_joints_test.cpp
  test/core/plan_merging_test.cpp
  test/core/plan_reduction_test.cpp
  test/core/plan_summary_test.cpp
  test/core/payload_test.cpp
  test/core/point_springs_test.cpp
  test/core/power_test.cpp
  test/core/printable_test.cpp
  test/core/property_bodies_test.cpp
  test/core/property_formalisms_test.cpp
  test/core/property_frames_test.cpp
  test/core/property_rerooting_test.cpp
  test/core/property_superposition_test.cpp
  test/core/rank_factorization_test.cpp
  test/core/recording_test.cpp
  test/core/reference_recursion_test.cpp
  test/core/reference_test.cpp
  test/core/run_time_histogram_test.cpp
  test/core/sample_block_test.cpp
  test/core/sample_clock_test.cpp
  test/core/sample_rows_test.cpp
  test/core/scene_reader_loops_test.cpp
  test/core/scene_reader_test.cpp
  test/core/shown_noise_test.cpp
  test/core/simplex_search_test.cpp
  test/core/sine_cosine_test.cpp
  test/core/spline_accuracy_test.cpp
  test/core/spline_test.cpp
  test/core/stability_test.cpp
  test/core/step_finder_test.cpp
  test/core/stream_identification_test.cpp
  test/core/stream_learner_test.cpp
  test/core/stream_smoother_test.cpp
  test/core/stream_surprise_test.cpp
  test/core/structured_loops_test.cpp
  test/core/summation_test.cpp
  test/core/table_law_test.cpp
  test/core/trajectory_curve_test.cpp
  test/core/unwrap_test.cpp
  test/core/urdf_reader_test.cpp
  test/core/urdf_writer_test.cpp
  test/core/velocity_judge_test.cpp
  test/core/wrench_history_test.cpp
  ${stability_scenes}
  src/offline/deviation_rows.cpp)  # the covariances of a motion cannot come from a file
# Compiled for each: where its tool and its data are, and tests of code that is all in headers.
set(core_test_files_of_build
  test/core/exact_products_test.cpp
  test/core/far_positions_test.cpp
  test/core/number_text_test.cpp
  test/core/offline_progress_test.cpp
  test/core/tested_build.cpp)

include(test/core/real_113.cmake)
# Instead of the sanitizers' checks, those of Eigen and the standard library; with which GCC 12 warns
# of strings that overlap, and is wrong.
set(checks_of_containers -UNDEBUG -D_GLIBCXX_ASSERTIONS)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  list(APPEND checks_of_containers -Wno-restrict)
endif()

add_library(core_test_objects OBJECT EXCLUDE_FROM_ALL ${core_test_files})
target_compile_options(core_test_objects PRIVATE
  $<TARGET_PROPERTY:${PROJECT_NAME}_warnings,INTERFACE_COMPILE_OPTIONS> ${checks_of_containers})
target_include_directories(core_test_objects PRIVATE include src test/core benchmark)
target_include_directories(core_test_objects SYSTEM PRIVATE
  ${EIGEN3_INCLUDE_DIRS} ${YAML_CPP_INCLUDE_DIR} ${GTEST_INCLUDE_DIRS})

# finish_core_tests(<target> <tool>)
function(finish_core_tests target tool)
  target_compile_definitions(${target} PRIVATE OFFLINE_TOOL="$<TARGET_FILE:${tool}>"
    VWD_SOURCE_DIR="${CMAKE_CURRENT_SOURCE_DIR}" VWD_SHARED_DATA="${VWD_SHARED_DATA}")
  target_compile_options(${target} PRIVATE ${checks_of_containers})
  target_link_libraries(${target} ${VWD_REAL113_LIBRARIES})
  add_dependencies(${target} ${tool})
endfunction()

vwd_add_gtest(core_tests $<TARGET_OBJECTS:core_test_objects> ${core_test_files_of_build})
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
add_executable(sanitized_core_tests
  $<TARGET_OBJECTS:core_test_objects> ${core_test_files_of_build})
target_include_directories(sanitized_core_tests PRIVATE src test/core)
target_link_libraries(sanitized_core_tests
  ${sanitized_library} ${PROJECT_NAME}_warnings ${gtest_libraries})
finish_core_tests(sanitized_core_tests ${sanitized_tool})
# Warnings are the other build's: GCC sees uninitialized variables in what the sanitizers add.
separate_arguments(sanitized_options UNIX_COMMAND
  "-O1 -g1 -UNDEBUG -fno-omit-frame-pointer -w ${sanitizers}")
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
