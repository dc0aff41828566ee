set(offline_files)
foreach(file
    arguments.cpp
    certified_rows.cpp
    check_report.cpp
    completed_motion.cpp
    computation.cpp
    deviation_rows.cpp
    lagrange_rows.cpp
    loop_report.cpp
    motion_file.cpp
    offline.cpp
    output_file.cpp
    result_writer.cpp
    rows.cpp
    watched_file.cpp)
  list(APPEND offline_files ${CMAKE_CURRENT_LIST_DIR}/${file})
endforeach()
