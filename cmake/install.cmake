# Installs what was built and virtual_work_dynamicsConfig.cmake: below the places of catkin, or, of the
# core alone, below those of any CMake package. virtual_work_dynamics::core is all that is exported;
# the exported files hold no path of this machine, and may be moved.
if(VWD_CORE_ONLY)
  include(GNUInstallDirs)
  set(vwd_programs ${CMAKE_INSTALL_BINDIR})
  set(vwd_libraries ${CMAKE_INSTALL_LIBDIR})
  set(vwd_headers ${CMAKE_INSTALL_INCLUDEDIR})
  set(vwd_data ${CMAKE_INSTALL_DATADIR}/${PROJECT_NAME})
  set(vwd_config ${CMAKE_INSTALL_LIBDIR}/cmake/${PROJECT_NAME})
else()
  set(vwd_programs ${CATKIN_PACKAGE_BIN_DESTINATION})
  set(vwd_libraries ${CATKIN_PACKAGE_LIB_DESTINATION})
  set(vwd_headers ${CATKIN_GLOBAL_INCLUDE_DESTINATION})
  set(vwd_data ${CATKIN_PACKAGE_SHARE_DESTINATION})
  # Where catkin_package() installs its own: Debian's catkin has another place below /usr.
  if(CATKIN_GLOBAL_LIB_DESTINATION STREQUAL "lib")
    set(vwd_config share/${PROJECT_NAME}/cmake)
  else()
    set(vwd_config ${CATKIN_GLOBAL_LIB_DESTINATION}/cmake/${PROJECT_NAME})
  endif()
endif()

# Programs find the library beside them, wherever both are moved; below /usr the system finds it.
if(NOT CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  file(RELATIVE_PATH vwd_libraries_of_programs "/${vwd_programs}" "/${vwd_libraries}")
  set_target_properties(${vwd_installed_programs} PROPERTIES
    INSTALL_RPATH "$ORIGIN/${vwd_libraries_of_programs}")
endif()
install(TARGETS ${vwd_installed_programs} RUNTIME DESTINATION ${vwd_programs})

string(REGEX MATCH "^[0-9]+\\.[0-9]+" vwd_soversion "${VWD_VERSION}")
set_target_properties(${PROJECT_NAME} PROPERTIES
  EXPORT_NAME core
  VERSION ${VWD_VERSION}
  SOVERSION ${vwd_soversion})
install(TARGETS ${PROJECT_NAME} EXPORT ${PROJECT_NAME}
  ARCHIVE DESTINATION ${vwd_libraries}
  LIBRARY DESTINATION ${vwd_libraries}
  RUNTIME DESTINATION ${vwd_programs}
  INCLUDES DESTINATION ${vwd_headers})
install(DIRECTORY include/${PROJECT_NAME} DESTINATION ${vwd_headers} FILES_MATCHING PATTERN "*.h")
install(DIRECTORY config urdf DESTINATION ${vwd_data})

install(EXPORT ${PROJECT_NAME}
  NAMESPACE ${PROJECT_NAME}::
  FILE ${PROJECT_NAME}Targets.cmake
  DESTINATION ${vwd_config})
install(FILES cmake/yaml_cpp.cmake DESTINATION ${vwd_config})
if(VWD_CORE_ONLY)
  install(FILES cmake/${PROJECT_NAME}-core.cmake
    DESTINATION ${vwd_config} RENAME ${PROJECT_NAME}Config.cmake)
  include(CMakePackageConfigHelpers)
  write_basic_package_version_file(
    ${CMAKE_CURRENT_BINARY_DIR}/${PROJECT_NAME}Config-version.cmake
    VERSION ${VWD_VERSION} COMPATIBILITY SameMajorVersion)
  #catkin_lint: ignore_once missing_file
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${PROJECT_NAME}Config-version.cmake
    DESTINATION ${vwd_config})
else()
  export(EXPORT ${PROJECT_NAME}
    NAMESPACE ${PROJECT_NAME}::
    FILE ${CATKIN_DEVEL_PREFIX}/share/${PROJECT_NAME}/cmake/${PROJECT_NAME}Targets.cmake)
  catkin_install_python(PROGRAMS scripts/identify.py scripts/read_input.py DESTINATION ${vwd_programs})
  install(DIRECTORY scripts/identification DESTINATION ${vwd_programs} FILES_MATCHING PATTERN "*.py")
  install(DIRECTORY launch DESTINATION ${vwd_data})
endif()
