vwd_core(
  closure_reader.cpp
  input_checks.cpp
  joint_terms.cpp
  resolved_loops.cpp
  scene.cpp
  scene_reader.cpp
  yaml_values.cpp)
