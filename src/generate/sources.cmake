vwd_core(
  c_names.cpp
  c_operations.cpp
  c_source.cpp
  expression_graph.cpp
  generated_code.cpp
  loop_model.cpp
  loop_recorder.cpp
  program.cpp
  recorder.cpp)

# Run the kernels' own code on terms, which stand in the places of doubles; the sanitizers see that code
# in the baseline.cpp of the kernels' folders, and with them GCC 12 would take minutes for it.
set_source_files_properties(
  ${CMAKE_CURRENT_LIST_DIR}/recorder.cpp ${CMAKE_CURRENT_LIST_DIR}/loop_recorder.cpp
  PROPERTIES COMPILE_FLAGS "${kernel_flags} -fno-sanitize=all -fno-strict-aliasing"
    SKIP_PRECOMPILE_HEADERS ON)
