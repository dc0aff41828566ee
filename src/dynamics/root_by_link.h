#pragma once

#include <Eigen/Core>

#include "loops/link_kinematics.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/root_motion.h"

namespace virtual_work_dynamics {

/// The motion of the root link from that of another link and of the joints between them, and back:
/// (2.1), (2.5), (2.7) along the chain, read from its other end. A sensor on a moving link so tells
/// of the root. Serves one thread. Does not allocate after construction.
class RootByLink {
 public:
  /// @param mechanism must outlive it
  explicit RootByLink(const Mechanism& mechanism) : mechanism_(mechanism), links_(mechanism) {}

  /// Sets how a link moves relative to the root link. To be called before the others.
  /// @param motion of all joints; that of the root is not looked at
  void place(const Motion& motion, int link);

  /// The motion of the root link, of whose origin the vectors then are.
  /// @param link motion of the link against the same inertial frame, vectors of the link's origin
  RootMotion rootOf(const RootMotion& link) const;
  /// The motion of the link when the root moves so.
  RootMotion linkOf(const RootMotion& root) const;

 private:
  struct Lever;
  Lever leverOf(const Eigen::Quaterniond& R_I0, const Eigen::Vector3d& w_0) const;

  const Mechanism& mechanism_;
  LinkKinematics links_;
  // Of the link relative to the root link, in root axes.
  Eigen::Quaterniond R_0L_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d p_ = Eigen::Vector3d::Zero();
  LinkKinematics::PointMotion relative_{p_, p_, p_, p_};
};

}  // namespace virtual_work_dynamics
