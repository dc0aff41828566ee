# Defines the target virtual_work_dynamics::core, with Eigen and yaml-cpp, which its headers include, and
# the function virtual_work_dynamics_generate().
# All of virtual_work_dynamicsConfig.cmake where the core is installed alone, and the end of the one
# that catkin makes, both in its devel space and where it installs.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 3.3)
find_dependency(yaml-cpp)
include("${CMAKE_CURRENT_LIST_DIR}/yaml_cpp.cmake")
include("${CMAKE_CURRENT_LIST_DIR}/virtual_work_dynamics-generate.cmake")

# In a workspace that catkin_make builds as a whole, it is a target of the same build.
if(NOT TARGET virtual_work_dynamics::core)
  include("${virtual_work_dynamics_DIR}/virtual_work_dynamicsTargets.cmake")
endif()
list(APPEND virtual_work_dynamics_LIBRARIES virtual_work_dynamics::core)
# For targets of catkin packages that are not linked, and have but catkin_INCLUDE_DIRS.
list(APPEND virtual_work_dynamics_INCLUDE_DIRS ${EIGEN3_INCLUDE_DIRS})
