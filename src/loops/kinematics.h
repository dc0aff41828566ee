#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/results.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// What the parent of a closure exerts on its child: moment about the child frame's origin. Root
/// axes.
struct ClosureWrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< N
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< N m
};

/// The conditions (3.3) of a mechanism's closures, Phi(q) = 0, with their velocities A qd, which
/// are those of (3.2), and accelerations A qdd + Ad qd, and the wrenches that go with their
/// multipliers. Everything in root axes. Nothing after construction allocates.
class LoopKinematics {
 public:
  /// @throws SceneError naming the closure: unknown link, both frames on one link, or on
  ///   links that no joint moves relative to each other.
  LoopKinematics(const Mechanism& mechanism, const Scene& scene);

  /// Number of conditions, of all closures.
  Eigen::Index conditions() const { return static_cast<Eigen::Index>(rows_.size()); }
  /// Conditions [firstOf(c), firstOf(c + 1)) are those of closure c.
  Eigen::Index firstOf(std::size_t closure) const { return first_[closure]; }
  /// Whether a condition is one of orientation, dimensionless; others are lengths in m.
  bool turns(Eigen::Index condition) const;

  /// Poses of links, conditions and their Jacobian at a position. Costs nothing where they are at
  /// that position already.
  void setPosition(const Eigen::VectorXd& q);
  const Eigen::VectorXd& phi() const { return phi_; }     ///< conditions, m or rad
  const Eigen::MatrixXd& jacobian() const { return A_; }  ///< A, conditions x coordinates
  /// Lengths of the rods of kDistance closures become those of the present position where the scene
  /// gives none; until then their conditions demand nothing.
  void adoptLengths();

  /// Velocities and accelerations of the conditions at the present position.
  void setMotion(const Motion& motion);
  const Eigen::VectorXd& rates() const { return rates_; }                  ///< A qd
  const Eigen::VectorXd& accelerations() const { return accelerations_; }  ///< A qdd + Ad qd
  /// Norms of what of phi(), rates() or accelerations() are a closure's lengths and directions.
  struct Norms {
    double lengths, directions;
  };
  Norms normsOf(std::size_t closure, const Eigen::VectorXd& conditions) const;

  /// Of a multiplier of one.
  ClosureWrench unitWrench(Eigen::Index condition) const;
  /// Of a unit effort about or along the free axis of a revolute or prismatic closure.
  ClosureWrench unitEffort(std::size_t closure) const;
  /// Direction of that axis.
  Eigen::Vector3d freeAxis(std::size_t closure) const { return axis(frames_[closure].parent, 2); }
  /// How far the child has turned about it, within half a turn, or slid along it, and how fast in
  /// the motion set last.
  double freePosition(std::size_t closure) const;
  double freeVelocity(std::size_t closure) const;
  /// Adds the generalized force of such a wrench on the child and its opposite on the parent.
  template <typename Vector>
  void addGeneralizedForce(std::size_t closure, const ClosureWrench& wrench, Vector&& force) const {
    const Eigen::Vector3d at = childOrigin(closure);
    for (const Step& step : frames_[closure].path) {
      const JointConstants& joint = joints_[static_cast<std::size_t>(step.joint)];
      if (joint.coordinate >= 0) force[joint.coordinate] += workOf(step, at, wrench);
    }
  }

  /// Frames at the present position.
  const Eigen::Matrix3d& axesOf(int link) const { return links_[static_cast<std::size_t>(link)].R; }
  const Eigen::Vector3d& originOf(int link) const {
    return links_[static_cast<std::size_t>(link)].o;
  }
  /// Axis of a joint; zero for fixed ones.
  const Eigen::Vector3d& axisOf(int joint) const {
    return links_[static_cast<std::size_t>(joint) + 1].z;
  }
  Eigen::Vector3d parentOrigin(std::size_t closure) const;
  Eigen::Vector3d childOrigin(std::size_t closure) const;
  Eigen::Matrix3d childAxes(std::size_t closure) const;
  /// Velocities of that frame, of the motion set last.
  Twist childTwist(std::size_t closure) const;
  /// Whether nothing may turn in a closure and its frames are more than a quarter turn apart, which
  /// its conditions do not see.
  bool reversed(std::size_t closure) const;
  int parentLink(std::size_t closure) const { return frames_[closure].parent.link; }
  int childLink(std::size_t closure) const { return frames_[closure].child.link; }

  /// Joints between the links of a closure, fixed ones included.
  struct Step {
    int joint;
    double sign;  ///< 1: moves the child's link, -1: the parent's
  };
  const std::vector<Step>& path(std::size_t closure) const { return frames_[closure].path; }

 private:
  enum class Kind { kAlong, kNormal, kDistance };
  struct Row {
    Kind kind;
    std::size_t closure;
    int a;  ///< axis of the parent frame
    int b;  ///< axis of the child frame
  };
  struct Frame {
    int link = 0;
    Eigen::Matrix3d R_LF;
    Eigen::Vector3d p_LoFo_L;
  };
  struct Frames {
    Frame parent, child;
    std::vector<Step> path;
    ClosureType type;
    double length = 0;
    bool adopts_length = false;
  };
  struct JointConstants {
    int parent_link, coordinate;
    bool slides;
    double multiplier, offset;
    Eigen::Matrix3d R_PK;
    Eigen::Vector3d p_PoKo_P, axis_K;
  };
  struct LinkState {
    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
    Eigen::Vector3d o = Eigen::Vector3d::Zero();
    Eigen::Vector3d z = Eigen::Vector3d::Zero();  ///< axis of its joint
    Eigen::Vector3d v = Eigen::Vector3d::Zero(), w = v, a = v, alpha = v;
  };
  struct PointState {
    Eigen::Vector3d o, v, w, a, alpha;
  };

  void addClosure(const Mechanism& mechanism, const Closure& closure);
  void addRows(std::size_t closure, ClosureType type);
  void moveLink(std::size_t k, const Motion& motion);
  double workOf(const Step& step, const Eigen::Vector3d& at, const ClosureWrench& wrench) const;
  PointState pointOf(const Frame& frame) const;
  void setRates(Eigen::Index condition, const PointState& parent, const PointState& child);
  Eigen::Vector3d axis(const Frame& frame, int i) const;

  std::vector<JointConstants> joints_;
  std::vector<LinkState> links_;
  std::vector<Frames> frames_;
  std::vector<Row> rows_;
  std::vector<Eigen::Index> first_;
  bool adopted_ = false;
  Eigen::VectorXd q_;  // position of all below
  Eigen::VectorXd phi_, rates_, accelerations_;
  Eigen::MatrixXd A_;
};

}  // namespace virtual_work_dynamics
