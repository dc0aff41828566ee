#pragma once

#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "witness/momentum/momentum.h"

namespace virtual_work_dynamics {

/// Where a link of the description is in the body it belongs to.
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
  std::vector<int> joints;  ///< index into Mechanism::joints() of each body's; -1: the root's
  std::vector<LinkPlace> places;
};

}  // namespace virtual_work_dynamics
