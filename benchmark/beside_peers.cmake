# The package beside other libraries: those that are found.
# Not by MuJoCo's package configuration: Debian's names a folder that does not exist.
find_path(VWD_MUJOCO_INCLUDE_DIR mujoco/mujoco.h)
find_library(VWD_MUJOCO_LIBRARY mujoco)
find_package(DART QUIET)
set(peers kdl)

# --- beside other libraries ------------------------------------------------------------------------
add_library(benchmark_contenders STATIC
  ../test/core/lagrange_multipliers_oracle.cpp  # without the checks of tests, as it is timed
  ../test/core/loop_geometry.cpp
  ../test/core/maximal_coordinates_freedoms.cpp
  ../test/core/maximal_coordinates_oracle.cpp
  ../test/core/newton_euler_oracle.cpp
  contenders/built_library.cpp
  contenders/check.cpp
  contenders/closed_scenes.cpp
  contenders/dense_linkage.cpp
  contenders/dense_loops.cpp
  contenders/kdl.cpp
  contenders/kdl_model.cpp
  contenders/linkages.cpp
  contenders/long_double_dynamics.cpp
  contenders/loop_formalisms.cpp
  contenders/offers.cpp
  contenders/own_block.cpp
  contenders/own_generated.cpp
  contenders/own_lagrange.cpp
  contenders/own_loops.cpp
  contenders/own_long_double.cpp
  contenders/own_single.cpp
  contenders/peer_input.cpp
  contenders/robots.cpp)
vwd_precompile(benchmark_contenders <Eigen/Core> <functional> <string> <vector>)
target_include_directories(benchmark_contenders PRIVATE ../src PUBLIC . ../test/core)  # the yardstick
set_source_files_properties(contenders/long_double_dynamics.cpp PROPERTIES COMPILE_FLAGS "${kernel_flags}" SKIP_PRECOMPILE_HEADERS ON)
target_include_directories(benchmark_contenders SYSTEM PRIVATE ${orocos_kdl_INCLUDE_DIRS})
target_compile_definitions(benchmark_contenders PRIVATE
  VWD_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
  VWD_SHARED_DATA="${VWD_SHARED_DATA}")
target_link_libraries(benchmark_contenders
  PUBLIC ${PROJECT_NAME} ${VWD_REAL113_LIBRARIES}
  PRIVATE ${orocos_kdl_LIBRARIES} ${CMAKE_DL_LIBS} ${PROJECT_NAME}_warnings)
if(VWD_KDL_TREE_SOLVER)
  target_compile_definitions(benchmark_contenders PRIVATE VWD_WITH_KDL_TREE)
endif()

if(VWD_MUJOCO_INCLUDE_DIR AND VWD_MUJOCO_LIBRARY)
  list(APPEND peers mujoco)
  target_sources(benchmark_contenders PRIVATE contenders/mujoco.cpp)
  target_compile_definitions(benchmark_contenders PRIVATE VWD_WITH_MUJOCO)
  target_include_directories(benchmark_contenders SYSTEM PRIVATE ${VWD_MUJOCO_INCLUDE_DIR})
  target_link_libraries(benchmark_contenders PRIVATE ${VWD_MUJOCO_LIBRARY})
endif()
if(DART_FOUND)
  list(APPEND peers dart)
  target_sources(benchmark_contenders PRIVATE contenders/dart.cpp)
  target_compile_definitions(benchmark_contenders PRIVATE VWD_WITH_DART)
  target_include_directories(benchmark_contenders SYSTEM PRIVATE ${DART_INCLUDE_DIRS})
  target_link_libraries(benchmark_contenders PRIVATE ${DART_LIBRARIES})
endif()
string(REPLACE ";" ", " peers "${peers}")
message(STATUS "Libraries to compare with: ${peers}")

add_executable(work_precision
  command_line.cpp
  cores.cpp
  measurement.cpp
  result_table.cpp
  work_precision.cpp
  work_precision_options.cpp)
target_include_directories(work_precision PRIVATE ../src)
target_link_libraries(work_precision
  PRIVATE benchmark_contenders benchmark::benchmark ${PROJECT_NAME}_warnings)

add_executable(callgrind_sample callgrind_sample.cpp)
target_link_libraries(callgrind_sample PRIVATE benchmark_contenders ${PROJECT_NAME}_warnings)

# --- what leaving out saves --------------------------------------------------------------------------
add_executable(leave_out
  command_line.cpp
  cores.cpp
  leave_out.cpp
  omissions.cpp
  same_numbers.cpp)
target_include_directories(leave_out PRIVATE ../src)
target_link_libraries(leave_out PRIVATE benchmark_contenders ${PROJECT_NAME}_warnings)

if(NOT VWD_CORE_ONLY)
  install(TARGETS callgrind_sample leave_out work_precision
    RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
endif()
