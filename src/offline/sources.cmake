set(offline_files)
foreach(file
    arguments.cpp
    certified_rows.cpp
    check_report.cpp
    loop_computation.cpp
    loop_lagrange.cpp
    loop_motion.cpp
    loop_report.cpp
    loop_rows.cpp
    loop_sample.cpp
    motion_file.cpp
    offline.cpp
    output_file.cpp
    result_writer.cpp
    rows.cpp)
  list(APPEND offline_files ${CMAKE_CURRENT_LIST_DIR}/${file})
endforeach()
