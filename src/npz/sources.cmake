set(npz_files)
foreach(file
    crc32.cpp
    npy_header.cpp
    npz_reader.cpp
    npz_writer.cpp)
  list(APPEND npz_files ${CMAKE_CURRENT_LIST_DIR}/${file})
endforeach()
