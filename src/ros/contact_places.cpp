#include "ros/contact_places.h"

#include <algorithm>
#include <cmath>

#include "base/number_text.h"
#include "base/printable.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

// What is further away, by the size of the loops, is elsewhere.
constexpr double kElsewhere = 0.01;

LoopResults loopsAt(const Mechanism& mechanism, const Scene& scene, const Motion& motion) {
  const Dynamics dynamics(mechanism, scene, Request());
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  dynamics.compute(motion, workspace);
  return workspace.results().loops;
}

// How far what sticks is from where it does so, along the plane.
double alongPlane(double all, double normal) {
  return std::sqrt(std::max(0.0, all * all - normal * normal));
}

}  // namespace

void placeContacts(const Mechanism& mechanism, const Motion& at,
                   const std::vector<std::size_t>& contacts, Scene& scene) {
  Motion motion = at;
  motion.qd.setZero();
  motion.qdd.setZero();
  scene.assembly.clear();
  for (std::size_t i = 0; i < mechanism.coordinateNames().size(); ++i) {
    scene.assembly.push_back(
        {mechanism.coordinateNames()[i], motion.q[static_cast<Eigen::Index>(i)]});
  }
  const LoopResults sticking = loopsAt(mechanism, scene, motion);
  Scene slipping_scene = scene;
  slipping_scene.free_motion = scene.actuated.has_value();  // else nothing moves freely
  for (const std::size_t c : contacts) {
    slipping_scene.closures[c].touch.slip = Slip::kAll;
    slipping_scene.closures[c].touch.friction.reset();
  }
  const LoopResults slipping = loopsAt(mechanism, slipping_scene, motion);
  for (const std::size_t c : contacts) {
    const auto away = [&](auto& of_sticking, auto& of_slipping) {
      return alongPlane(of_sticking[c].position, of_slipping[c].position);
    };
    if (away(sticking.relative_residuals, slipping.relative_residuals) <= kElsewhere) continue;
    throw SceneError("closures: " + inQuotes(scene.closures[c].name) + " would stick " +
                     numberText(away(sticking.residuals, slipping.residuals)) +
                     " m away from where it is: its joints do not lead there from the assembly");
  }
}

}  // namespace virtual_work_dynamics
