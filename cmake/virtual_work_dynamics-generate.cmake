# virtual_work_dynamics_generate(<target> <robot.urdf> [<scene.yaml>] [<option>...])
#
# Adds a static library of the code that `inverse_dynamics_offline --generate` writes for a robot and a
# scene: <target>.h declares <target>_compute() and <target>_compute_block(). It is written again when
# the description, the scene or the tool changes. Options are those of the tool that go with --generate,
# as --axes child, --reactions none, --no-efforts. The code is compiled for the machines that the rest
# of the package is compiled for; target_compile_options(<target> PRIVATE -mavx2 -mfma) makes it faster
# where these are known to be there.
function(virtual_work_dynamics_generate target urdf)
  set(options ${ARGN})
  get_filename_component(urdf "${urdf}" ABSOLUTE)
  set(inputs "${urdf}")
  set(command --urdf "${urdf}")
  if(options)
    list(GET options 0 scene)
    if(NOT scene MATCHES "^-")
      list(REMOVE_AT options 0)
      get_filename_component(scene "${scene}" ABSOLUTE)
      list(APPEND inputs "${scene}")
      list(APPEND command --scene "${scene}")
    endif()
  endif()

  # In a build of several packages at once the tool may be a target; otherwise it is where the package is.
  if(TARGET inverse_dynamics_offline)
    set(tool $<TARGET_FILE:inverse_dynamics_offline>)
    list(APPEND inputs inverse_dynamics_offline)
  else()
    find_program(VIRTUAL_WORK_DYNAMICS_OFFLINE inverse_dynamics_offline
      HINTS "${virtual_work_dynamics_DIR}/../../../lib/virtual_work_dynamics"
        "${virtual_work_dynamics_DIR}/../../../bin"
      NO_DEFAULT_PATH)
    if(NOT VIRTUAL_WORK_DYNAMICS_OFFLINE)
      message(FATAL_ERROR "inverse_dynamics_offline is not where virtual_work_dynamics is, "
        "${virtual_work_dynamics_DIR}")
    endif()
    set(tool "${VIRTUAL_WORK_DYNAMICS_OFFLINE}")
    list(APPEND inputs "${tool}")
  endif()

  get_property(languages GLOBAL PROPERTY ENABLED_LANGUAGES)
  set(ending cpp)
  if("C" IN_LIST languages)
    set(ending c)
  endif()
  set(folder "${CMAKE_CURRENT_BINARY_DIR}/${target}_generated")
  file(MAKE_DIRECTORY "${folder}")
  add_custom_command(
    OUTPUT "${folder}/${target}.${ending}" "${folder}/${target}.h"
    COMMAND ${tool} ${command} --generate "${folder}/${target}.${ending}" ${options}
    DEPENDS ${inputs}
    COMMENT "Generating ${target}.${ending}"
    VERBATIM)
  add_library(${target} STATIC "${folder}/${target}.${ending}" "${folder}/${target}.h")
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_include_directories(${target} PUBLIC "${folder}")
  # A build without a type would be one without optimization.
  target_compile_options(${target} PRIVATE $<$<NOT:$<CONFIG:Debug>>:-O2>)
  target_link_libraries(${target} PUBLIC m)
endfunction()
