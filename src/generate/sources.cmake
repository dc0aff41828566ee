vwd_core(
  c_names.cpp
  c_operations.cpp
  c_source.cpp
  expression_graph.cpp
  generated_code.cpp
  program.cpp
  recorder.cpp)

# Runs the kernels' own code on terms; the sanitizers see that code in tree/kernel/baseline.cpp, and with
# them GCC 12 would take minutes for it.
set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/recorder.cpp
  PROPERTIES COMPILE_FLAGS "${kernel_flags} -fno-sanitize=all" SKIP_PRECOMPILE_HEADERS ON)
