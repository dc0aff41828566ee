vwd_core(
  motion_completion.cpp
  motion_csv.cpp
  motion_estimator.cpp
  motion_law.cpp
  polynomial_fit.cpp
  spline.cpp
  unwrap.cpp)
