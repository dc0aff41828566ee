vwd_core(
  certificates.cpp
  error_bound.cpp
  lagrange/lagrange_dynamics.cpp
  lagrange/lagrange_plan.cpp
  momentum/baseline.cpp
  momentum/welded_bodies.cpp)

vwd_core_vectors(momentum/avx2.cpp)

set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/momentum/baseline.cpp
  PROPERTIES COMPILE_FLAGS -Wno-psabi SKIP_PRECOMPILE_HEADERS ON)
if(VWD_X86)
  set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/momentum/avx2.cpp
    PROPERTIES COMPILE_FLAGS "-ffp-contract=fast -Wno-psabi -mavx2 -mfma")
endif()
