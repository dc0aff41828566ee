vwd_core(
  description_shares.cpp
  deviations.cpp
  dynamics.cpp
  given_joints.cpp
  passive_joints.cpp
  shifted_samples.cpp
  sample_rows.cpp)
