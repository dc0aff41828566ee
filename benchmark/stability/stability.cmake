# Errors where scenes go to extremes, against 113 bits.
add_executable(stability
  command_line.cpp
  contenders/long_double_dynamics.cpp
  stability/kdl_efforts.cpp
  stability/measure.cpp
  stability/own_paths.cpp
  stability/stability.cpp
  stability/stability_options.cpp
  $<TARGET_OBJECTS:core_oracles>
  $<TARGET_OBJECTS:stability_scenes>)
set_source_files_properties(contenders/long_double_dynamics.cpp
  PROPERTIES COMPILE_FLAGS "${kernel_flags}" SKIP_PRECOMPILE_HEADERS ON)
target_include_directories(stability PRIVATE . ../src ../test/core)  # the yardstick
target_link_libraries(stability
  PRIVATE ${PROJECT_NAME} ${VWD_REAL113_LIBRARIES} Threads::Threads ${PROJECT_NAME}_warnings)
if(orocos_kdl_FOUND)
  target_sources(stability PRIVATE contenders/kdl_model.cpp contenders/peer_input.cpp)
  target_include_directories(stability SYSTEM PRIVATE ${orocos_kdl_INCLUDE_DIRS})
  target_link_libraries(stability PRIVATE ${orocos_kdl_LIBRARIES})
  target_compile_definitions(stability PRIVATE VWD_WITH_KDL)
  if(VWD_KDL_TREE_SOLVER)
    target_compile_definitions(stability PRIVATE VWD_WITH_KDL_TREE)
  endif()
else()
  message(STATUS "Stability is measured without KDL's errors beside (Debian, Ubuntu: "
    "liborocos-kdl-dev)")
endif()

# Closed loops of random mechanisms in which much is special.
add_executable(structured_loops
  command_line.cpp
  stability/structured_loops_main.cpp
  $<TARGET_OBJECTS:core_oracles>
  $<TARGET_OBJECTS:stability_scenes>)
target_include_directories(structured_loops PRIVATE . ../src ../test/core)  # the yardstick
target_link_libraries(structured_loops
  PRIVATE ${PROJECT_NAME} ${VWD_REAL113_LIBRARIES} Threads::Threads ${PROJECT_NAME}_warnings)

# Assemblies from starts at which loops are open.
add_executable(assembly_starts command_line.cpp stability/assembly_starts.cpp
  $<TARGET_OBJECTS:core_oracles>)
target_include_directories(assembly_starts PRIVATE . ../src ../test/core)
target_link_libraries(assembly_starts
  PRIVATE ${PROJECT_NAME} Threads::Threads ${PROJECT_NAME}_warnings)

if(NOT VWD_CORE_ONLY)
  install(TARGETS stability structured_loops assembly_starts RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
endif()
