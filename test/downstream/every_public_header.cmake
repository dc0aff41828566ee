# Writes every_public_header.h, which includes every header that users of virtual_work_dynamics::core
# are given.
get_target_property(include_dirs virtual_work_dynamics::core INTERFACE_INCLUDE_DIRECTORIES)
set(includes)
foreach(include_dir ${include_dirs})
  file(GLOB headers RELATIVE ${include_dir} ${include_dir}/virtual_work_dynamics/*.h)
  foreach(header ${headers})
    set(includes "${includes}#include \"${header}\"\n")
  endforeach()
endforeach()
if(NOT includes)
  message(FATAL_ERROR "no headers in ${include_dirs}")
endif()
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/every_public_header.h "#pragma once\n\n${includes}")
