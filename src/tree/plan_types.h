#pragma once

#include "tree/vec3.h"

namespace virtual_work_dynamics {

// What plans are made of, in plain data: kernels for other instruction sets include this and
// nothing else of the library.

/// How a body moves on its parent.
enum class Mobility : unsigned char { kRevolute, kPrismatic, kFixed, kOriented };

/// Where the z axis of a frame points in the axes of another. For all except kOblique the rotation
/// between them is Q of canonicalRotation(): a signed permutation, or one with four entries.
enum class AxisDirection : unsigned char {
  kOblique,
  kNormalToX,  ///< in the y-z plane, and so on
  kNormalToY,
  kNormalToZ,
  kPlusX,
  kMinusX,
  kPlusY,
  kMinusY,
  kPlusZ,
  kMinusZ
};

/// How a wrench is reported that is plain: of a revolute body, drives one effort one to one, is
/// handed to the body before it, and is reported, if it is, with all that the joint bears.
enum class PlainReport : unsigned char {
  kNone,
  kChildAxes,
  kRootAxes,  ///< and in child axes, or not
  kNotPlain
};

/// What of a body matters to the request, and how the sweeps reach it.
struct BodyUse {
  /// Revolute, moved one to one by its coordinate, with inertia, and reached from the body before
  /// it: the kernel asks nothing else of its motion.
  /// Its rotation in root axes is not needed.
  bool plain_motion = false;
  bool turned_motion = false;  ///< the same of a body whose rotation in root axes is needed
  PlainReport plain_wrench = PlainReport::kNotPlain;
  int feeds = -1;  ///< the body that is reached from this one, next in the sweep; -1: none

  int parent = -1;
  Mobility mobility = Mobility::kFixed;
  AxisDirection axis = AxisDirection::kOblique;  ///< of the body's z axis, in its parent's Z frame

  bool motion_needed = false;
  bool wrench_needed = false;
  bool pose_needed = false;  ///< R_0Z and p_0
  bool bears_point = false;  ///< its position says where the point or axis of a moment is
  bool reported = false;     ///< its wrench is a result in some axes
  /// Its reaction in root axes is its wrench in its parent's axes, turned as the parent is: its own
  /// rotation is not needed for it.
  bool turned_by_parent = false;
  bool has_inertia = false;

  // Constants that are zero, so that their products are left out.
  bool centred = false;   ///< h is zero
  bool diagonal = false;  ///< the entries of G off its diagonal are zero
  bool offset_x = true;   ///< whether components of r_{k,k-1} can be other than zero
  bool offset_y = true;
  bool offset_z = true;

  bool parent_rests = false;  ///< the parent neither turns nor accelerates, except for -g
  bool rest_along_z = false;  ///< the parent rests, and its gamma is along the joint axis or zero
  bool weightless = false;    ///< the parent rests, and gamma of this body is zero
  bool takes_from_next = false;  ///< a child's wrench arrives in registers
  bool hands_on = false;         ///< its wrench goes to the parent in registers
  bool adds_to_parent = false;   ///< its wrench goes to the parent in memory
  bool starts_sum = false;       ///< its wrench is the first of a sum in memory
  bool drives = false;           ///< its active component is part of a requested effort
  bool summed = false;           ///< other bodies have added to that effort before
  bool geared = false;           ///< the multiplier is not 1

  int parent_slot = -1;  ///< where the parent's motion is kept; -1: it was the last
  int own_slot = -1;     ///< where its motion is kept for children that come later
  int angle = -1;        ///< index into Plan::angles
  int slide = -1;        ///< index into Plan::slides
  int coordinate = -1;   ///< the coordinate that moves it; -1: fixed
  int orientation = -1;  ///< the orientation of the sample behind R_PZ; -1: none
  int child_axes = -1;   ///< index into Plan::child_axes
  int root_axes = -1;    ///< index into Plan::root_axes

  int sums_into = -1;     ///< index of the wrench it is added to: the parent's, or a partial sum
  int carries_begin = 0;  ///< range of Plan::carries that follow the addition
  int carries_end = 0;
};

/// A partial sum of a hub's children that moves on: hubs sum pairwise, so that errors grow with the
/// logarithm of the number of children.
struct Carry {
  int from = 0;         ///< indices of wrenches
  int to = 0;           ///<
  bool starts = false;  ///< nothing is at `to` yet
};

/// One rigid body of the recursion with everything that is welded to it; constants in its z-aligned
/// frame Z. Body 0 is the root, parents stand before their children, depth first.
template <typename T>
struct Body : BodyUse {
  T multiplier = T(1);   ///< velocity = multiplier * qd[coordinate]
  Mat3<T> R_PZ{};        ///< orientation in the parent's Z frame at position 0, less the phase
  Vec3<T> p_PoZo_P{};    ///< O_k in the parent's Z frame at position 0, m
  T mass = T(0);         ///< kg
  Vec3<T> h{};           ///< first moment of mass about O_k, kg m
  Sym3<T> G{};           ///< second moment of mass about O_k, kg m^2
  Vec3<T> gamma_rest{};  ///< R_PZ^T gamma of a parent at rest, m/s^2
};

/// Position of a joint: multiplier * q[coordinate] + offset; a joint that turns has a constant
/// rotation about z, the phase, behind it.
template <typename T>
struct JointPosition {
  int coordinate = 0;
  bool geared = false;  ///< multiplier is not 1 or offset not 0
  bool turned = false;  ///< phase is not 0
  T multiplier = T(1);
  T offset = T(0);
  T phase_cos = T(1);
  T phase_sin = T(0);
};

/// What acts between a joint's actuator and the mechanism, see JointTerms: position, velocity and
/// acceleration of the joint are multiplier times the coordinate's, the position more by `offset`,
/// from where its spring is relaxed.
template <typename T>
struct ActuatorTerms {
  int coordinate = 0;
  T multiplier = T(1);
  T offset = T(0);
  T stiffness = T(0);
  T damping = T(0);
  T coulomb = T(0);
  T per_velocity = T(0);  ///< 1 / JointTerms::coulomb_velocity
  T rotor_inertia = T(0);
  T constant = T(0);  ///< JointTerms::offset
};

/// What a joint leaves to its actuators of the wrench that passes through it, in Z axes of its
/// body.
enum class ActivePart : unsigned char {
  kAxis,      ///< of a joint of one freedom: force along z where it slides, moment where it turns
  kPlane,     ///< forces across z and the moment about it
  kCylinder,  ///< force along z and the moment about it
  kScrew,     ///< the moment about z that does as much work as both
  kBall,      ///< all moments
  kAll,       ///< everything
  kCross      ///< moments, except for that about the normal to both axes of a universal joint
};

/// A reaction to report.
template <typename T>
struct ReactionOutput {
  int body = -1;  ///< -1: known to be zero
  /// R_KZ: Z components -> components in the child link. A signed permutation moves component i to
  /// `row[i]` with `sign[i]`.
  Mat3<T> R_KZ{};
  bool permutes = false;
  bool flips = false;  ///< whether an entry of that permutation is -1
  int row[3] = {0, 1, 2};
  T sign[3] = {T(1), T(1), T(1)};
  bool drop_active = false;  ///< the active part is reported as zero
  ActivePart active = ActivePart::kAxis;
  T pitch = T(0);      ///< of a screw, m/rad
  Vec3<T> normal_P{};  ///< of a universal joint: that normal, in the Z frame of the body's parent
};

/// A step on the way from the body that a point is fixed on to the one whose reaction is reported.
struct PointStep {
  int body = 0;
  bool down = false;  ///< from its parent to the body; else from the body to its parent
};

/// A reaction whose moment is reported about a point other than O_k.
template <typename T>
struct MovedMoment {
  int output = -1;            ///< index into Plan::root_axes or Plan::child_axes
  bool in_root_axes = false;  ///< which of them
  int steps_begin = 0;        ///< range of Plan::point_steps
  int steps_end = 0;          ///<
  Vec3<T> p_ZoPo_Z{};         ///< the point in the body that it is fixed on, m
};

/// Where an applied wrench acts; its force and torque live with the caller.
template <typename T>
struct AppliedOutside {
  int body = -1;  ///< -1: acts on a body that matters to no requested result
  bool in_root_axes = false;
  Mat3<T> R_ZL{};          ///< link axes -> Z
  Vec3<T> p_ZoA_Z{};       ///< point of action, m
  PlainWrench<T> given{};  ///< the scene's values: link or root axes, about the point of action
};

}  // namespace virtual_work_dynamics
