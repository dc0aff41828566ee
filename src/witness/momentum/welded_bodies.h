#pragma once

#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "witness/momentum/momentum.h"

namespace virtual_work_dynamics {

/// Place of a link of the description in the body it belongs to.
struct LinkPlace {
  int body = 0;
  Matrix3l R_ZL = Matrix3l::Identity();
  Vector3l p_ZoLo_Z = Vector3l::Zero();
  long double distance = 0;  ///< from the body's origin along the welded joints, m
};

/// The bodies of a mechanism, a body for each joint that moves and for the root, and what moves
/// each of them.
struct WeldedBodies {
  explicit WeldedBodies(const Mechanism& mechanism);

  std::vector<MomentumBody> bodies;
  std::vector<int> joints;  ///< by body: index of its joint in Mechanism::joints(); -1: the root
  std::vector<LinkPlace> places;
  /// A body that turns on from an orientation of the motion: R_PZ = before R(orientation) after.
  struct Oriented {
    std::size_t body = 0;
    std::size_t orientation = 0;
    Eigen::Matrix3d before, after;
  };
  std::vector<Oriented> oriented;
};

}  // namespace virtual_work_dynamics
