#include "scene/bare_scene.h"

namespace virtual_work_dynamics {

Scene bareScene(Scene scene) {
  scene.applied_wrenches.clear();
  scene.payloads.clear();
  scene.springs.clear();
  scene.joints.clear();
  scene.use_urdf_dynamics = false;
  scene.strict_inertia = false;  // a body may have an inertia without a mass here
  return scene;
}

}  // namespace virtual_work_dynamics
