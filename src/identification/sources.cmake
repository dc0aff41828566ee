vwd_core(
  parameters.cpp
  regressor.cpp)
