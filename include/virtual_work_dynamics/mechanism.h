#pragma once

#include <Eigen/Core>
#include <string>
#include <unordered_map>
#include <vector>

namespace virtual_work_dynamics {

using Vector3l = Eigen::Matrix<long double, 3, 1>;
using Matrix3l = Eigen::Matrix<long double, 3, 3>;

/// Name under which the wrench that ground exerts on the root link is requested and reported.
constexpr char kGround[] = "ground";

enum class JointType {
  kRevolute,
  kContinuous,
  kPrismatic,
  kFixed,
  /// Part of a joint that turns freely: holds its child link at an orientation that each motion
  /// gives, Motion::orientations, from which the parts after it turn.
  kOriented
};

/// What a position measures, of a coordinate, a joint or a condition.
enum class Unit { kRadian, kMetre };

/// "rad" or "m".
const char* symbolOf(Unit unit);
/// What counts as one in a mechanism of size `length`, m: 1 rad or the length.
constexpr double scaleOf(Unit unit, double length) {
  return unit == Unit::kMetre ? length : 1;
}
/// What counts as one of the effort that does work on it, for a force of 1 N: the length for
/// moments, 1 for forces.
constexpr double effortScaleOf(Unit unit, double length) {
  return unit == Unit::kMetre ? 1 : length;
}

/// A rigid body of the description. Constants are long double so that they are rounded only once,
/// when a scene is compiled.
struct Link {
  std::string name;
  int parent_joint = -1;                     ///< index of the joint that carries it; -1: root
  long double mass = 0;                      ///< kg
  Vector3l p_KoCm_K = Vector3l::Zero();      ///< centre of mass, link axes, m
  Matrix3l inertia_Cm_K = Matrix3l::Zero();  ///< about the centre of mass, link axes, kg m^2
};

/// A joint of the description. Its frame K is the child link's.
struct Joint {
  std::string name;
  JointType type = JointType::kFixed;
  int parent_link = 0;
  int child_link = 0;                    ///< always the joint's own index + 1
  Vector3l p_PoKo_P = Vector3l::Zero();  ///< joint origin in the parent link at q = 0, m
  Matrix3l R_PK = Matrix3l::Identity();  ///< orientation in the parent link at q = 0
  Vector3l axis_K = Vector3l::Zero();    ///< unit vector; zero for fixed joints
  /// Index of the generalized coordinate that moves it; -1: fixed. A mimic joint has its master's.
  int coordinate = -1;
  bool mimics = false;
  int orientation = -1;   ///< of an oriented joint: index into Motion::orientations
  double multiplier = 1;  ///< joint position = multiplier * q[coordinate]
  double offset = 0;      ///< + offset, rad or m
  double damping = 0;   ///< as described, viscous, N m s/rad or N s/m; see Scene::use_urdf_dynamics
  double friction = 0;  ///< as described, dry, N m or N
  /// Limits as described, rad or m; equal: none. They do not limit motions, and serve only to tell
  /// what a driver that wraps has left out (TurnCounter).
  double lower = 0, upper = 0;
  /// Limits as described, N m or N and rad/s or m/s; 0: none, as descriptions that know none write
  /// it. They limit nothing, and serve to tell how close to them a motor runs.
  double effort_limit = 0, velocity_limit = 0;
};

/// What the position of a joint that moves measures.
Unit unitOf(const Joint& joint);

/// What a joint of several freedoms leaves free, and a screw, whose turn and slide are one freedom.
enum class CompoundType {
  kPlanar,       ///< slides along two axes of a plane, then a turn about its normal
  kCylindrical,  ///< a slide along an axis and a turn about it
  kUniversal,    ///< a turn about an axis of the parent, then about one of the child
  kScrew,        ///< a turn about an axis with a slide along it, tied by the pitch
  kSpherical,    ///< all turns
  kFloating      ///< slides along the axes of the joint's frame on the parent, then all turns
};

/// A joint of the description or scene that is not a joint of one axis. The mechanism has a chain
/// of such joints in its place, its parts, with links between them that have no mass. The first
/// part hangs on the joint's parent link, the last one carries its child link.
struct CompoundJoint {
  std::string name;
  CompoundType type = CompoundType::kPlanar;
  int first = 0;     ///< parts: the joints from this index
  int last = 0;      ///< to this one; the reaction of the whole joint is that of the last part
  double pitch = 0;  ///< of a screw, m per revolution; positive is right-handed

  /// Whether it turns freely: an orientation is then part of its position.
  bool turnsFreely() const {
    return type == CompoundType::kSpherical || type == CompoundType::kFloating;
  }
};

/// Something questionable in a description that is computed all the same; one line for the user.
struct Doubt {
  std::string text;
  bool about_inertia = false;  ///< true: fatal under a scene's `strict_inertia`
};

/// A joint or an actuator of a transmission.
struct TransmissionEnd {
  std::string name;
  double reduction = 1;
  double offset = 0;  ///< of a joint: its position where the actuators are at zero, rad or m
};

/// A transmission of a description, as ros_control has them. Its ratios count only where a scene
/// asks for them, see withTransmissions().
struct Transmission {
  std::string name;
  std::string type;  ///< without its package: "DifferentialTransmission"
  std::vector<TransmissionEnd> joints, actuators;  ///< in the order of their roles
  std::string problem;                             ///< why it cannot be asked for; empty: it can
  std::string unread;  ///< what the doubts say as long as it is not; empty: nothing
};

/// What a robot description says: a tree of links. Immutable. Joints are in depth-first order, the
/// children of a link by joint name, so a parent always stands before its child; links()[0] is the
/// root and links()[i + 1] hangs on joints()[i].
class Mechanism {
 public:
  /// Takes links and joints in the order above. The urdf_reader makes them; tests may, too.
  /// @throws UrdfError when that order is broken.
  Mechanism(std::string name, std::vector<Link> links, std::vector<Joint> joints,
            std::vector<Doubt> doubts = {}, std::vector<CompoundJoint> compounds = {},
            std::vector<Transmission> transmissions = {});

  const std::string& name() const { return name_; }
  const std::vector<Link>& links() const { return links_; }
  const std::vector<Joint>& joints() const { return joints_; }
  const std::vector<Doubt>& doubts() const { return doubts_; }
  const std::vector<CompoundJoint>& compounds() const { return compounds_; }
  /// Those of the description that no scene has asked for.
  const std::vector<Transmission>& transmissions() const { return transmissions_; }
  /// The link or joint of that index, which must be one.
  const Link& link(int index) const { return links_[static_cast<std::size_t>(index)]; }
  const Joint& joint(int index) const { return joints_[static_cast<std::size_t>(index)]; }

  /// Indices into joints() of the generalized coordinates: every movable joint that mimics no
  /// other.
  const std::vector<int>& coordinates() const { return coordinates_; }
  /// Number of orientations that a motion has: one for each joint that turns freely.
  std::size_t orientations() const { return free_joints_.size(); }
  /// The joint that turns freely of an orientation.
  const CompoundJoint& freeJoint(std::size_t orientation) const {
    return compounds_[free_joints_[orientation]];
  }
  /// The first of the three coordinates, angles about x, y and z, of the joint of an orientation.
  int anglesOf(std::size_t orientation) const {
    return joint(freeJoint(orientation).last).coordinate - 2;
  }
  /// Names of the joints in coordinates(), in that order.
  const std::vector<std::string>& coordinateNames() const { return coordinate_names_; }
  /// The joint that a generalized coordinate is the position of, and what it measures.
  const Joint& jointOf(int coordinate) const {
    return joint(coordinates_[static_cast<std::size_t>(coordinate)]);
  }
  Unit unitOf(int coordinate) const { return virtual_work_dynamics::unitOf(jointOf(coordinate)); }

  /// Index of the joint or link of that name; -1 when there is none. Not for the per-sample path.
  int jointIndex(const std::string& name) const;
  int linkIndex(const std::string& name) const;
  /// Index in coordinates() of the joint of that name; -1 when none moves by itself under it.
  int coordinateIndex(const std::string& name) const;

  /// The compound joint that a joint is part of; null where it is a joint of its own.
  const CompoundJoint* compoundOf(int joint) const;
  /// Whether a joint is a part of a compound joint other than its last, and so has no reaction of
  /// its own.
  bool isInnerPart(int joint) const;
  /// Index of the joint whose reaction has that name, which of a compound joint is its last part;
  /// -1 when there is none. Parts have no reaction under their own names.
  int reactionIndex(const std::string& name) const;
  /// The name of the reaction of a joint that is not an inner part.
  const std::string& reactionName(int joint) const;

 private:
  std::string name_;
  std::vector<Link> links_;
  std::vector<Joint> joints_;
  std::vector<Doubt> doubts_;
  std::vector<CompoundJoint> compounds_;
  std::vector<Transmission> transmissions_;
  std::vector<int> compound_of_;          // by joint, index into compounds_; empty: there are none
  std::vector<std::size_t> free_joints_;  // by orientation, index into compounds_
  std::vector<int> coordinates_;
  std::vector<std::string> coordinate_names_;
  std::unordered_map<std::string, int> index_of_joint_;
  std::unordered_map<std::string, int> index_of_link_;
  std::unordered_map<std::string, int> index_of_compound_;
};

}  // namespace virtual_work_dynamics
