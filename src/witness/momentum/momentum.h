#pragma once

#include <cstddef>

namespace virtual_work_dynamics {

// Momentum and energy of a mechanism for the certificates, from the orientations R of its bodies in
// root axes and their derivatives R', R'': products of matrices only, so that no formula for
// accelerations, inertia forces or moments is that of the recursion (kernel/). Compiled for several
// instruction sets under the same rules as the kernels; see kernel/kernel.h.

/// A body with everything that is welded to it. Its frame Z has the origin of the joint that
/// carries it, and its z axis along the joint's; body 0 is the root. Constants are rounded once.
struct MomentumBody {
  int parent = 0;
  bool slides = false;
  bool empty = false;  ///< neither mass nor inertia

  double R_PZ[9] = {};  ///< by columns, at position 0; see MomentumJoint
  double p_PoZo_P[3] = {};
  double mass = 0;
  double h[3] = {};  ///< first moment of mass about the origin
  double G[6] = {};  ///< second moment about the origin: xx, xy, xz, yy, yz, zz

  // Norms as ErrorBound takes them of each link, added up on the way through welded joints.
  double distance = 0;  ///< from the parent's origin
  double first = 0;     ///< sum of m |r_C|
  double second = 0;    ///< sum of the norms of the inertias about the origin
};

/// Position and motion of the joint that carries a body.
struct MomentumJoint {
  double R_PZ[9] = {};  ///< by columns, at the joint's position
  double slide = 0;
  double slide_norm = 0;  ///< sum of the magnitudes of the terms of the slide
  double rate = 0;
  double acceleration = 0;
};

/// An applied wrench, with its norms for the scales.
struct MomentumWrench {
  int body = 0;
  bool in_root_axes = false;
  double p_ZoA_Z[3] = {};
  double force[3] = {};   ///< Z or root axes
  double torque[3] = {};  ///< about the point of action
  double force_norm = 0;
  double moment_norm = 0;  ///< about the body's origin
};

struct MomentumInputs {
  const MomentumBody* bodies;
  const MomentumJoint* joints;  ///< [0], the root's, is not read
  std::size_t body_count;
  const MomentumWrench* wrenches;
  std::size_t wrench_count;
  // Of the root, in its axes at the instant: derivatives of its orientation, by columns, and the
  // acceleration of its origin less gravity, in a frame in which the origin has no velocity.
  double root_D[9] = {};
  double root_E[9] = {};
  double gamma_root[3];
  // Sums of norms for them.
  double w_norm = 0;
  double alpha_norm = 0;
  double gamma_norm;
};

/// What the wrench of ground, in root axes and about the root's origin, and the power of the
/// efforts must be, with the sums of the magnitudes of all terms.
struct MomentumSums {
  double force[3];
  double moment[3];
  double power;
  double force_scale;
  double moment_scale;
  double power_scale;
};

/// Memory for one body, aligned to kVectorAlignment, is `state_size` bytes.
struct Momentum {
  std::size_t state_size;
  void (*sum)(const MomentumInputs& in, void* states, MomentumSums& sums);
};

// The builds of these sums; null where the compiler cannot make one.
const Momentum* baselineMomentum();
const Momentum* avx2Momentum();

}  // namespace virtual_work_dynamics
