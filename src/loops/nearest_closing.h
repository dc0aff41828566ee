#pragma once

#include <Eigen/Core>
#include <vector>

#include "loops/groups.h"
#include "loops/kinematics.h"

namespace virtual_work_dynamics {

/// Closes loops from a start that is off by up to a radian, at the solution nearest to it: by least
/// squares in bounded steps, as a continuous path would lead there, with redundant constraints or
/// without. The misfit it lessens is the distance and the angle between what a closure joins, which
/// is the same whichever of its links is the parent, and which grows up to half a turn, as the
/// conditions themselves do not. Where it finds no solution, or only one far away, it sets out
/// again from beside the start. For assembly: it allocates.
class NearestClosing {
 public:
  /// @param scales by coordinate: 1, or the length for slides
  /// @param length makes lengths comparable with angles, m
  NearestClosing(LoopKinematics& kinematics, std::vector<LoopGroup> groups,
                 std::vector<double> scales, double length);

  /// Moves the coordinates that are not given from where they are; leaves the kinematics at the
  /// position found. Returns false when loops stay open, with `q` where they are open least.
  bool close(Eigen::VectorXd& q, const std::vector<bool>& given);

 private:
  struct System;  // of one group, at one position
  struct Attempt {
    Eigen::VectorXd q;
    double misfit = 0, moved = 0;  // moved: distance from the start, rad or over the length
    bool better(const Attempt& other) const;
  };
  bool closeGroup(const LoopGroup& group, Eigen::VectorXd& q, const std::vector<bool>& given);
  Attempt descend(const LoopGroup& group, const Eigen::VectorXd& start, const Eigen::VectorXd& from,
                  const std::vector<int>& moving);
  void setSystem(const LoopGroup& group, const std::vector<int>& moving, System& system) const;
  void addClosure(std::size_t closure, System& system) const;
  double scale(int coordinate) const { return scales_[static_cast<std::size_t>(coordinate)]; }

  LoopKinematics& kinematics_;
  const std::vector<LoopGroup> groups_;
  const std::vector<double> scales_;
  double length_;
};

}  // namespace virtual_work_dynamics
