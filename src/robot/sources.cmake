vwd_core(
  inertia_doubts.cpp
  mechanism.cpp
  urdf_angles.cpp
  urdf_reader.cpp)
