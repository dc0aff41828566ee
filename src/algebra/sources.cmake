vwd_core(
  elimination_order.cpp
  least_norms.cpp
  multifrontal_qr.cpp
  rank_factorization.cpp)
