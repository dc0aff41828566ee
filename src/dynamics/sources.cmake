vwd_core(
  dynamics.cpp
  given_joints.cpp
  passive_joints.cpp
  sample_rows.cpp)
