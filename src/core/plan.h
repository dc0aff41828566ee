#pragma once

#include <vector>

#include "core/vec3.h"
#include "virtual_work_dynamics/inverse_dynamics.h"

namespace virtual_work_dynamics {

/// How a body moves on its parent.
enum class Mobility { kRevolute, kPrismatic, kFixed };

/// One rigid body of the recursion with everything that is welded to it; constants in its z-aligned
/// frame Z. Body 0 is the root, parents stand before their children.
template <typename T>
struct Body {
  int parent = -1;
  Mobility mobility = Mobility::kFixed;
  int coordinate = -1;  ///< position = multiplier * q[coordinate] + offset; -1: fixed
  T multiplier = T(1);
  T offset = T(0);
  Mat3<T> R_PZ{};              ///< orientation in the parent's Z frame at position 0
  Vec3<T> p_PoZo_P{};          ///< O_k in the parent's Z frame at position 0, m
  T mass = T(0);               ///< kg
  Vec3<T> h{};                 ///< first moment of mass about O_k, kg m
  Sym3<T> G{};                 ///< second moment of mass about O_k, kg m^2
  bool wrench_needed = false;  ///< false: only its motion matters to the request
  bool pose_needed = false;    ///< R_0Z and p_0 of this body matter to the request
};

/// A reaction to report.
template <typename T>
struct ReactionOutput {
  int body = 0;
  Mat3<T> R_KZ{};            ///< Z components -> components in the child link
  bool drop_active = false;  ///< the component along the joint axis is reported as zero
};

/// Where an applied wrench acts; its force and torque live in the workspace.
template <typename T>
struct AppliedOutside {
  int body = -1;  ///< -1: acts on a body that matters to no requested result
  bool in_root_axes = false;
  Mat3<T> R_ZL{};     ///< link axes -> Z
  Vec3<T> p_ZoA_Z{};  ///< point of action, m
  Vec3<T> force{};    ///< the scene's values, as given: link or root axes, N
  Vec3<T> torque{};   ///< about the point of action, N m
};

/// A mechanism, a scene and a request, compiled: the constants of the recursion.
template <typename T>
struct Plan {
  int coordinates = 0;
  bool efforts = true;
  bool static_motion = false;
  bool twists = false;
  Vec3<T> gamma_root{};  ///< -g, m/s^2
  std::vector<Body<T>> bodies;
  std::vector<ReactionOutput<T>> child_axes;
  std::vector<ReactionOutput<T>> root_axes;
  std::vector<AppliedOutside<T>> applied;
};

/// Compiles in long double. @throws SceneError, see InverseDynamics.
Plan<long double> compilePlan(const Mechanism& mechanism, const Scene& scene,
                              const Request& request);

/// The same plan with every constant rounded once.
template <typename T>
Plan<T> roundPlan(const Plan<long double>& plan);

}  // namespace virtual_work_dynamics
