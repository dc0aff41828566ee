#pragma once

#include <vector>

#include "virtual_work_dynamics/given.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Where a motion starts.
struct MotionStart {
  Given given;
  Motion motion;  ///< positions of all coordinates; those that are not given do not count
  Motion driven;  ///< values of the driven numbers
};

/// Returns the scene with its loops started for a motion: Scene::given says what the motion gives,
/// and given positions replace those of Scene::assembly, unless the loops are closed from the
/// assembly as it is, lead from there to the motion's start, and are not clearly further from
/// closed there than at the motion's start. A motion that gives all joints so needs no assembly.
/// Allocates; compiles the loops once or twice.
/// @throws SceneError naming what is wrong with the scene; AssemblyError when the loops can be
///   closed from neither start; GivenError when the motion gives too little or too much.
Scene startedBy(const Mechanism& mechanism, const Scene& scene, const MotionStart& start);

}  // namespace virtual_work_dynamics
