set(replay_files)
foreach(file
    bag_run.cpp
    bag_topics.cpp
    dumped_parameters.cpp
    happenings.cpp
    input_bytes.cpp
    input_topics.cpp
    loop_notes.cpp
    replayed_states.cpp
    replayed_wrenches.cpp)
  list(APPEND replay_files ${CMAKE_CURRENT_LIST_DIR}/${file})
endforeach()
