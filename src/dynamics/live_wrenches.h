#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/wrench_history.h"
#include "loops/link_kinematics.h"
#include "virtual_work_dynamics/load.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion_covariance.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// The live wrenches of a scene as they are measured, and the loads that they make. Poses of the
/// frames that they are measured in are those of the mechanism's own kinematics at the position of
/// the sample, and that of the inertial frame is that of the root's motion. Serves one thread. Does
/// not allocate after construction.
class LiveWrenches {
 public:
  /// @param timeout s, positive; see WrenchHistory
  /// @throws SceneError when the mechanism lacks the link of a live wrench.
  LiveWrenches(const Mechanism& mechanism, const Scene& scene, double timeout);

  /// Number of live wrenches, which have the scene's order.
  std::size_t size() const { return wrenches_.size(); }
  const std::string& name(std::size_t i) const { return wrenches_[i].name; }

  /// Takes a measurement of a wrench, as its sensor says.
  WrenchHistory::Verdict push(std::size_t i, const MeasuredWrench& wrench) {
    return wrenches_[i].history.push(wrench);
  }
  const WrenchHistory& history(std::size_t i) const { return wrenches_[i].history; }

  /// Reads all live wrenches at an instant, for getLoad().
  /// @returns the first one that is not known there, or nothing.
  std::optional<std::size_t> read(std::int64_t stamp_ns);
  /// Whether one of those read last is an older one that is held.
  bool anyHeld() const;

  /// Writes the load of the instant read last at the position of a motion.
  /// @param load has one wrench for each applied wrench of the scene; those that are not live keep
  ///   their values
  void getLoad(const Motion& motion, Load& load);
  /// Writes the covariances of the load of getLoad() at the same position: what the deviations of
  /// the sensors make of it. How a wrench that is held has changed since is no part of them.
  /// @param covariances one for each applied wrench of the scene; those that are not live keep
  ///   theirs
  void getCovariances(std::vector<WrenchCovariance>& covariances) const;

 private:
  struct Live {
    std::string name;
    std::size_t applied;  // place in the scene
    int link;
    double sign;
    WrenchDeviation deviation;
    WrenchHistory history;
    WrenchHistory::Reading reading;
  };

  bool movesFrames() const;
  struct Placed {
    Eigen::Matrix3d R_LF;
    Eigen::Vector3d p_LoFo_L;
  };
  Placed frameOf(const Live& live, const MeasuredWrench& measured) const;
  Wrench onLink(const Live& live, const MeasuredWrench& measured) const;
  WrenchCovariance covarianceOf(const Live& live, const MeasuredWrench& measured) const;

  std::vector<Live> wrenches_;
  LinkKinematics links_;
  RootMotion root_;  // of the latest load
};

}  // namespace virtual_work_dynamics
