# A user of generated code: of a description of the build folder, which changes.
configure_file(${CMAKE_CURRENT_LIST_DIR}/../../urdf/composed_pendulum.urdf
  ${CMAKE_CURRENT_BINARY_DIR}/generated.urdf COPYONLY)
virtual_work_dynamics_generate(downstream_generated ${CMAKE_CURRENT_BINARY_DIR}/generated.urdf
  ${CMAKE_CURRENT_LIST_DIR}/generated_scene.yaml --reactions none)
add_executable(downstream_of_generated ${CMAKE_CURRENT_LIST_DIR}/generated.cpp)
target_link_libraries(downstream_of_generated downstream_generated)
