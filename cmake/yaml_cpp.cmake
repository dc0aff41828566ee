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
  # Versions 0.6 of Debian and Ubuntu name a folder that is relative, or is not there; Ubuntu's 0.5 one
  # that is /usr/include by way of others, by which name the compiler must not be given it.
  if(IS_ABSOLUTE "${YAML_CPP_INCLUDE_DIR}" AND IS_DIRECTORY "${YAML_CPP_INCLUDE_DIR}")
    get_filename_component(_vwd_yaml_cpp_include "${YAML_CPP_INCLUDE_DIR}" REALPATH)
    set_property(TARGET virtual_work_dynamics::yaml_cpp
      PROPERTY INTERFACE_INCLUDE_DIRECTORIES "${_vwd_yaml_cpp_include}")
    unset(_vwd_yaml_cpp_include)
  endif()
  unset(_vwd_yaml_cpp)
endif()
