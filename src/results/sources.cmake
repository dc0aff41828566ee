vwd_core(results.cpp)
