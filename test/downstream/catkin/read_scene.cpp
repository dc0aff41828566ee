#include "virtual_work_dynamics/scene_reader.h"

int main() {
  const YAML::Node node = YAML::Load("{gravity: [0, 0, -1.62]}");
  return virtual_work_dynamics::readScene(node).gravity.z() == -1.62 ? 0 : 1;
}
