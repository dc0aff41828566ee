set(npz_files)
foreach(file
    crc32.cpp
    npz_reader.cpp
    npz_writer.cpp)
  list(APPEND npz_files ${CMAKE_CURRENT_LIST_DIR}/${file})
endforeach()
