# For whole builds in less time: sources that include the same headers are compiled six at a time, so that
# templates of these are instantiated once for all of them. Off by default: it hides includes that are left
# out, and compiles more anew after a change.
set(vwd_joined_at_once 6)

# vwd_join(<target>): the sources of a library, whose names in unnamed namespaces have to differ. Files with
# flags of their own stay by themselves.
function(vwd_join target)
  if(VWD_JOIN_SOURCES)
    set_target_properties(${target} PROPERTIES
      UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${vwd_joined_at_once})
    # GCC warns of members from unnamed namespaces where these are not the compiled file's own.
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
    endif()
  endif()
endfunction()

# vwd_joined_tests(<variable> <file>...): sets the files to compile for these. Tests have helpers of the
# same names in their unnamed namespaces, which are named after their files here; others than *_test.cpp,
# which use such names outside, stay by themselves.
function(vwd_joined_tests variable)
  if(NOT VWD_JOIN_SOURCES)
    set(${variable} ${ARGN} PARENT_SCOPE)
    return()
  endif()
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${ARGN})
  set(tests ${ARGN})
  list(FILTER tests INCLUDE REGEX "_test\\.cpp$")
  set(joined)
  set(text "")
  set(count 0)
  list(LENGTH tests left)
  foreach(file ${tests})
    get_filename_component(name ${file} NAME_WE)
    file(READ ${PROJECT_SOURCE_DIR}/${file} source)
    string(REPLACE "\nnamespace {\n" "\nnamespace of_${name} {\n" source "${source}")
    string(APPEND text "#line 1 \"${PROJECT_SOURCE_DIR}/${file}\"\n${source}\n")
    math(EXPR count "${count} + 1")
    math(EXPR left "${left} - 1")
    math(EXPR rest "${count} % ${vwd_joined_at_once}")
    if(rest EQUAL 0 OR left EQUAL 0)
      list(LENGTH joined number)
      set(path ${CMAKE_CURRENT_BINARY_DIR}/joined_tests/tests_${number}.cpp)
      file(GENERATE OUTPUT ${path} CONTENT "${text}")
      list(APPEND joined ${path})
      set(text "")
    endif()
  endforeach()
  set(others ${ARGN})
  list(REMOVE_ITEM others ${tests})
  set(${variable} ${joined} ${others} PARENT_SCOPE)
endfunction()
