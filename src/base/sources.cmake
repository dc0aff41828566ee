vwd_core(
  instruction_set.cpp
  nearest_name.cpp
  npy_header.cpp
  number_text.cpp
  output_file.cpp
  printable.cpp
  run_time_histogram.cpp
  text_file.cpp
  worker_threads.cpp)

if(VWD_X86)
  set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/instruction_set.cpp
    PROPERTIES COMPILE_DEFINITIONS VWD_VECTOR_KERNELS SKIP_PRECOMPILE_HEADERS ON)
endif()
