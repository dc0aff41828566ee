vwd_core(
  elimination_order.cpp
  least_norms.cpp
  multifrontal_qr.cpp
  rank_factorization.cpp)

# Fronts of single loops have few rows: vector instructions cost more than they spare.
set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/multifrontal_qr.cpp PROPERTIES
  COMPILE_OPTIONS -fno-tree-vectorize SKIP_PRECOMPILE_HEADERS ON)
