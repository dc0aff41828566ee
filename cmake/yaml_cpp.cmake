# Defines virtual_work_dynamics::yaml_cpp, to be included after find_package(yaml-cpp): one name for
# a library whose target is yaml-cpp up to version 0.7 and yaml-cpp::yaml-cpp since 0.8. The installed
# package has this file too, and so does not depend on the version that it was built with.
if(NOT TARGET virtual_work_dynamics::yaml_cpp)
  add_library(virtual_work_dynamics::yaml_cpp INTERFACE IMPORTED)
  set(_vwd_yaml_cpp yaml-cpp)
  if(TARGET yaml-cpp::yaml-cpp)
    set(_vwd_yaml_cpp yaml-cpp::yaml-cpp)
  elseif(YAML_CPP_LIBRARIES)
    set(_vwd_yaml_cpp "${YAML_CPP_LIBRARIES}")
  endif()
  set_property(TARGET virtual_work_dynamics::yaml_cpp
    PROPERTY INTERFACE_LINK_LIBRARIES "${_vwd_yaml_cpp}")
  # Ubuntu 20.04 names a folder that is not there.
  if(IS_DIRECTORY "${YAML_CPP_INCLUDE_DIR}")
    set_property(TARGET virtual_work_dynamics::yaml_cpp
      PROPERTY INTERFACE_INCLUDE_DIRECTORIES "${YAML_CPP_INCLUDE_DIR}")
  endif()
  unset(_vwd_yaml_cpp)
endif()
