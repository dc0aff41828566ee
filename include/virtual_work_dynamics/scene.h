#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// Axes in which a vector is given.
enum class Axes { kLink, kRoot };

/// Standard deviations of a wrench, the same ones of each component; at least zero.
struct WrenchDeviation {
  double force = 0;   ///< N
  double torque = 0;  ///< N m
};

/// A wrench that acts on a link from outside: (3.6) without the weight.
struct AppliedWrench {
  std::string link;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();      ///< point of action, link frame, m
  Axes axes = Axes::kLink;                           ///< axes of force and torque
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< N
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< moment about `at`, N m
  /// Under this name programs get force and torque that change: a Load replaces the scene's.
  std::string name;
  /// Whether force and torque are not known to the scene. They count as zero there, about the
  /// origin of the link and in its axes, where `at`, `axes`, `force` and `torque` are as they are
  /// by default.
  bool live = false;
  /// Of a live wrench: what is received is what the link exerts, the opposite of what acts on it.
  bool invert = false;
  /// How well force and torque are known, those of a Load, too; none: they count as exact. See
  /// Deviations.
  std::optional<WrenchDeviation> deviation;
};

/// A rigid body that is fixed on a link, besides what the description says of the link.
struct Payload {
  std::string link;
  double mass = 0;                                    ///< kg, more than zero
  Eigen::Vector3d at = Eigen::Vector3d::Zero();       ///< centre of mass, link frame, m
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about it, axes of the link, kg m^2
};

/// Frame of a joint or closure.
enum class JointFrame {
  kParent,  ///< fixed on the parent link: a joint's at its position zero, a closure's parent frame
  kChild    ///< fixed on the child link: the child link's own, a closure's child frame
};

/// The point about which the moment of a reaction is reported instead of the child frame's origin.
/// Its axes stay as requested.
struct MomentPoint {
  std::string name;  ///< a joint, fixed ones too, or a closure; each once
  /// What the point is fixed on: a frame of the joint or closure, or the frame of any link.
  JointFrame frame = JointFrame::kChild;
  std::optional<std::string> link;               ///< none: `frame` counts
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< the point in that frame, m
};

/// Spring, damping, friction, rotor inertia and a constant effort between a joint's actuator and
/// the mechanism. They are part of the effort that the actuator must deliver and of no reaction.
/// Every number except `rest` and `offset` is at least zero.
struct JointTerms {
  std::string joint;              ///< a joint that moves; mimic joints have terms of their own
  double stiffness = 0;           ///< stiffness of a spring, N m/rad or N/m
  double rest = 0;                ///< position at which the spring is relaxed, rad or m
  std::optional<double> damping;  ///< viscous, N m s/rad or N s/m; none: see use_urdf_dynamics
  std::optional<double> coulomb;  ///< dry friction, N m or N; none: see use_urdf_dynamics
  /// Velocity from which on dry friction acts in full, rad/s or m/s, at least 1e-12. Friction is
  /// coulomb * s (3 - s^2) / 2 with s = qd / coulomb_velocity held within [-1, 1], which passes
  /// zero smoothly.
  double coulomb_velocity = 1e-3;
  double rotor_inertia = 0;  ///< at the joint: gear ratio squared included, kg m^2 or kg
  double offset = 0;         ///< effort needed in every position and motion, N m or N
};

/// A joint with other freedoms than those that the description can say, in place of one of its
/// joints.
struct JointTypeEntry {
  std::string joint;  ///< name of a joint of the description
  CompoundType type = CompoundType::kUniversal;
  /// In the frame of the joint, of any length: the axis, of a plane its normal; none: that of the
  /// description's joint.
  std::optional<Eigen::Vector3d> axis;
  /// Of a universal joint, which must have one: the axis of the child link, where its angles are 0.
  std::optional<Eigen::Vector3d> axis2;
  /// Of a screw, which must have one, m per revolution. Positive is right-handed.
  std::optional<double> pitch;
};

/// A frame on a link.
struct LinkFrame {
  std::string link;
  Eigen::Vector3d xyz = Eigen::Vector3d::Zero();  ///< origin in the link's frame, m
  Eigen::Vector3d rpy = Eigen::Vector3d::Zero();  ///< orientation, as in a URDF: fixed x, y, z, rad
};

/// What a closure leaves free of the motion of its child frame relative to its parent frame.
enum class ClosureType {
  kFixed,        ///< nothing
  kRevolute,     ///< a turn about z
  kPrismatic,    ///< a slide along z
  kCylindrical,  ///< a turn about z and a slide along z
  kUniversal,    ///< turns about the parent's z and the child's x, which stay normal to each other
  kSpherical,    ///< all turns
  kPlanar,       ///< slides along x and y and a turn about z
  kDistance,     ///< everything except the distance of the origins: a massless rod
  // Pairs that touch in a point, which bear a force and no moment; see Touch. The parent frame is
  // the plane: z is its normal, its origin one of its points.
  kRolling,    ///< a wheel on a plane: its centre is the child frame's origin, z its axle
  kKnifeEdge,  ///< a blade on a plane: its point is the child frame's origin, x goes along it
  kContact,    ///< a point of the child, its frame's origin, on a plane
  kCylinder,   ///< a massless actuator along the line between the origins
  // Teeth, which bear a force at the pitch point; see Teeth. Joints hold the axes of the wheels.
  kGear,  ///< two wheels: frames at their centres, z along their axes
  kRack   ///< a wheel, the parent, and a rack, whose pitch line is x of the child frame
};

/// Which of its two motions in the plane a wheel or a point is free to make.
enum class Slip {
  kNone,     ///< neither
  kRolling,  ///< along its rolling direction: it only does not slip sideways
  kLateral,  ///< sideways
  kAll       ///< both: there is no friction
};

/// Distances of a point above its plane at which a program closes and opens its contact, m.
struct Gap {
  double close = 0;  ///< at or below it: closed
  double open = 0;   ///< above it: open; more than `close`. In between it stays as it is.
};

/// What a wheel, a blade or a point on a plane has besides its frames.
struct Touch {
  double radius = 0;       ///< of a wheel, m; without a tube it touches with a sharp edge
  double tube_radius = 0;  ///< of the tube around its edge, a torus, m; a ball is nothing else
  bool normal = true;      ///< false: joints hold the height, nothing presses on the plane
  Slip slip = Slip::kNone;
  /// Of rollers around a wheel, which turn freely: the angle of the axis of the one that touches
  /// from the axle, about the normal, rad. The wheel holds along that axis only.
  std::optional<double> roller_angle;
  std::optional<double> friction;  ///< coefficient; none: the cone is not checked
  bool closed = true;              ///< false: what touches is lifted and bears nothing
  /// Of a contact that programs close and open by where the motion has its point.
  std::optional<Gap> gap;
};

/// What wheels with teeth have besides their frames. The pitch point lies where circles or lines of
/// these radii touch, at the height of the child frame.
struct Teeth {
  double parent_radius = 0;  ///< of the parent's pitch circle, m; negative: its teeth are inside
  double child_radius = 0;   ///< of the child's, of kGear
  double pressure_angle =
      0.3490658503988659;  ///< normal to the tooth, rad, from 0; as a rule 20 deg
  /// Of helical teeth, rad. Positive: what pushes the child along the parent's turn about z pushes
  /// it along z, too.
  double helix_angle = 0;
};

/// A joint that closes a loop of the mechanism: two frames on two links.
struct Closure {
  std::string name;
  ClosureType type = ClosureType::kFixed;
  LinkFrame parent;
  LinkFrame child;
  /// Distance of the origins of kDistance, m; none: their distance in the assembly.
  std::optional<double> length;
  Touch touch = {};         ///< of kRolling, kKnifeEdge and kContact
  bool pulls_only = false;  ///< of kCylinder: a cable, which is flagged when it would push
  Teeth teeth = {};         ///< of kGear and kRack
};

/// A massless spring and damper between two points of the mechanism, which pulls them together by
/// stiffness (l - rest_length) + damping dl/dt, where l is their distance.
struct PointSpring {
  std::string name;
  std::string link_a, link_b;
  Eigen::Vector3d at_a = Eigen::Vector3d::Zero();  ///< point in the frame of link_a, m
  Eigen::Vector3d at_b = Eigen::Vector3d::Zero();  ///< point in the frame of link_b, m
  double stiffness = 0;                            ///< N/m; zero only where there is damping
  double rest_length = 0;                          ///< m
  double damping = 0;                              ///< N s/m
};

/// A number that belongs to a joint or a closure.
struct NamedNumber {
  std::string name;
  double value = 0;
};

/// A linear relation between coordinates, such as gears, belts and differentials make: the sum of
/// factors times positions is the offset. Positions are those of whole turns, not within one. The
/// sum has the unit of the first joint's position, factors of joints of the other kind carry a
/// length. Its effort, N m or N to match, acts on each coordinate by the factor times the effort;
/// it loads no bearing.
struct Coupling {
  std::string name;
  /// Joints, or free axes of closures (withClosureAxes()), each once; of compounds their parts.
  std::vector<NamedNumber> terms;
  std::optional<double> offset;  ///< rad or m; none: what the sum is in the assembly
  bool rate_only = false;  ///< ties velocities and accelerations alone, as a slipping belt does
};

/// Functions of time that say how something is driven.
enum class DriveFunction {
  kPolynomial,   ///< sum of coefficients times powers of t, also in pieces
  kCosine,       ///< amplitude (1 - cos(2 pi t / period))
  kSine,         ///< amplitude sin(2 pi t / period + phase)
  kSineSweep,    ///< as sineSweepLaw()
  kMinimumJerk,  ///< as minimumJerkLaw(), at rest before and after
  kTable         ///< as tableLaw(), with the times as they are
};

/// A joint, or a closure's one free axis, whose motion is a function of the time t. Motions need
/// not give it; what they say of it is not used. It counts as actuated: its effort is what drives
/// it.
struct DriveLaw {
  std::string name;  ///< of a joint that moves, or of a closure with one free axis
  DriveFunction function = DriveFunction::kPolynomial;
  double offset = 0;           ///< added to the function, rad or m
  double amplitude = 0;        ///< rad or m
  double period = 0;           ///< s
  double phase = 0;            ///< rad
  double start_frequency = 0;  ///< Hz
  double end_frequency = 0;    ///< Hz
  double duration = 0;         ///< s
  /// Of points and rows; of a polynomial where its pieces start, s. Of one without pieces: none.
  std::vector<double> times;
  /// Of each piece of a polynomial, in rad or m over powers of s; its t is zero where it starts.
  std::vector<std::vector<double>> coefficients;
  std::vector<double> positions;      ///< rad or m
  std::vector<double> velocities;     ///< of a table, rad/s or m/s; none: not given
  std::vector<double> accelerations;  ///< of a table, rad/s^2 or m/s^2; none: not given
};

/// Which of many solutions is reported for forces that rigid-body mechanics does not determine.
enum class RedundancyPolicy {
  kMinimumNorm,  ///< the least sum of squares of the closures' forces and moments over `length`
  kZeroAt,       ///< as little as possible at the closures named, then as kMinimumNorm
  kStiffness  ///< least sum of squares of reactions, each over its joint's or closure's stiffness
};

/// How to choose the forces that rigid-body mechanics does not determine. Where there are more
/// actuated joints than degrees of freedom, the efforts of the least weighted sum of squares are
/// chosen first, whatever the policy: they are for the controller to choose, not for the stiffness
/// of joints. The policy chooses among the forces that are then left.
struct Redundancy {
  RedundancyPolicy policy = RedundancyPolicy::kMinimumNorm;
  std::vector<std::string> zero_at;         ///< names of closures, for kZeroAt
  std::vector<NamedNumber> stiffness;       ///< joints and closures, relative; others: 1
  std::vector<NamedNumber> effort_weights;  ///< actuated joints, in least squares; others: 1
  /// Tolerance of the rank of the length-scaled system, relative. Closures whose frames fit each
  /// other to within it count as closed.
  double rank_tolerance = 1e-10;
  std::optional<double> length;  ///< m, makes moments comparable with forces; none: automatic
};

/// How well the description is known: relative standard deviations, independent for each link, from
/// 0 to below 1.
struct Tolerances {
  double mass = 0;     ///< of a link's mass
  double inertia = 0;  ///< of a link's moments of inertia about its centre of mass, all alike

  bool any() const { return mass > 0 || inertia > 0; }
};

/// Which reactions a scene asks for.
enum class ReactionSelection {
  kAll,  ///< every movable joint, mimic joints included, and every closure
  kNone,
  kNamed  ///< those in Scene::reaction_names; fixed joints and "ground" only this way
};

/// Which transmissions of the description a scene asks for.
enum class TransmissionSelection {
  kNone,
  kAll,
  kNamed  ///< those in Scene::transmission_names
};

/// What acts on a mechanism and which of its forces a user asks for; names are resolved when the
/// scene is compiled (InverseDynamics).
struct Scene {
  Eigen::Vector3d gravity{0, 0, -9.81};  ///< m/s^2, inertial axes: those of a root link that rests
  bool root_moves = false;               ///< motions say how the root link moves, Motion::root
  bool static_motion = false;            ///< velocities and accelerations are taken as zero
  ReactionSelection reactions = ReactionSelection::kAll;
  std::vector<std::string> reaction_names;
  /// False: the component of a reaction along the joint axis is reported as zero.
  bool include_active = true;
  /// Moments that are reported about points of their own, of reactions that are asked for.
  std::vector<MomentPoint> moments_about;
  bool strict_inertia = false;  ///< impossible inertias are an error rather than a doubt
  std::vector<Payload> payloads;
  std::vector<AppliedWrench> applied_wrenches;
  std::vector<JointTerms> joints;  ///< terms of some joints, each once
  /// Joints of other types than described; withJointTypes() makes the mechanism that has them,
  /// which goes with this scene.
  std::vector<JointTypeEntry> joint_types;
  /// True: damping and friction of the description count for joints whose terms do not give them.
  bool use_urdf_dynamics = false;
  Tolerances tolerances;  ///< see Deviations
  /// Transmissions of the description whose actuators become joints; withTransmissions() makes the
  /// mechanism that has them, and the scene that goes with it.
  TransmissionSelection transmissions = TransmissionSelection::kNone;
  std::vector<std::string> transmission_names;  ///< of kNamed
  /// Of a scene that withTransmissions() has made: by joint, the actuators that move it.
  std::map<std::string, std::vector<std::string>> actuators_of;

  std::vector<Closure> closures;  ///< empty: an open chain
  std::vector<PointSpring> springs;
  std::vector<Coupling> couplings;
  /// Joints, and closures with one free axis, that carry effort; the others are passive. None:
  /// every joint of the tree is actuated, and no closure.
  std::optional<std::vector<std::string>> actuated;
  /// True: what moves with nothing that holds it is no error. The efforts that it would take beyond
  /// those of the actuators are the residual of the motion, see ClosedLoopDynamics::residual().
  bool free_motion = false;
  /// What motions give, from which the closures determine the rest: joints, closures with one free
  /// axis, and "pose.<link>" for poses of links; see Given. None: the actuated joints.
  std::optional<std::vector<std::string>> given;
  std::vector<DriveLaw> drives;  ///< see Drives; what they drive is given besides `given`
  /// Positions of joints from which the loops are assembled; other joints start at 0. Joints that
  /// motions give stay where they start.
  std::vector<NamedNumber> assembly;
  Redundancy redundancy;
  /// True: programs find the intervals that forces can be in; see Request::intervals.
  bool contact_intervals = false;
};

/// Whether a scene has closures, springs, couplings or passive joints, or says what motions give,
/// which only ClosedLoopDynamics knows.
bool needsClosedLoops(const Scene& scene);

/// Names of the reactions that the scene asks for: "ground" first, then joints in depth-first
/// order, then closures in the scene's order.
/// @throws SceneError for a name that is neither a joint nor a closure, or that is given twice.
std::vector<std::string> requestedReactions(const Mechanism& mechanism, const Scene& scene);

}  // namespace virtual_work_dynamics
