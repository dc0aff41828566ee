#pragma once

#include "loops/closure_conditions.h"
#include "loops/condition.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// The free axis of a closure moves as LoopState::driven says: a row of A qd + b = 0 (3.2) with b
/// the rate that is given, reversed.
class FreeAxisDrive : public ConditionSet {
 public:
  /// @param closure revolute or prismatic; must outlive this
  /// @param number its place in LoopState::driven
  FreeAxisDrive(const std::string& name, const ClosureConditions& closure, Eigen::Index number);

  const std::vector<PathStep>* levers() const override { return &closure_.path(); }
  void setPosition(const LoopState& state, ConditionRows rows) const override;
  void setMotion(const LoopState& state, ConditionRows rows) const override;

 private:
  const ClosureConditions& closure_;
  const Eigen::Index number_;
};

/// The frame of a link moves as LoopState::driven says: three rows for its origin and three for its
/// axes, in root axes.
class PoseDrive : public ConditionSet {
 public:
  /// @param link that joints of the tree move
  /// @param number place of the first of its Given::kPoseNumbers in LoopState::driven
  /// @throws SceneError when no joint moves the link.
  PoseDrive(const Mechanism& mechanism, int link, Eigen::Index number);

  const std::vector<PathStep>* levers() const override { return &path_; }
  void setPosition(const LoopState& state, ConditionRows rows) const override;
  void setMotion(const LoopState& state, ConditionRows rows) const override;

 private:
  PoseDrive(const std::string& link_name, int link, std::vector<PathStep> path,
            std::vector<int> coordinates, Eigen::Index number);

  const LinkKinematics::Frame frame_;
  const std::vector<PathStep> path_;
  const Eigen::Index number_;
};

}  // namespace virtual_work_dynamics
