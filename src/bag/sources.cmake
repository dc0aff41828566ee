set(bag_files)
foreach(file
    bag_connections.cpp
    bag_reader.cpp
    bag_records.cpp
    bag_writer.cpp
    chunk_compression.cpp
    joint_state_bytes.cpp)
  list(APPEND bag_files ${CMAKE_CURRENT_LIST_DIR}/${file})
endforeach()
