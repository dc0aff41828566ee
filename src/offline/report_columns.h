#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/results.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// The columns that results with closed loops have for a load report alone: how close a row is to a
/// singular position, and how fast closures turn.
class ReportColumns {
 public:
  /// @param mechanism must outlive it
  ReportColumns(const Mechanism& mechanism, const Scene& scene);

  /// "condition", then turningColumn() of each closure that turns.
  const std::vector<std::string>& names() const { return names_; }
  /// Appends the cells of a row.
  void add(const Motion& motion, const Results& results, std::vector<double>& cells);

  /// The column of a closure's angular velocity: that of its child against its parent about z of
  /// its child frame, rad/s. Empty where it does not turn about that, or where that is not known.
  static std::string turningColumn(const Mechanism& mechanism, const Closure& closure);

 private:
  struct Turning {
    int parent, child;    // links
    Eigen::Vector3d z_C;  // axis in the child link
  };
  struct LinkTurn {
    Eigen::Matrix3d R_RK;  // orientation in the root link
    Eigen::Vector3d w_R;   // angular velocity against it, root axes, rad/s
  };

  const Mechanism& mechanism_;
  std::vector<std::string> names_;
  std::vector<Turning> turnings_;
  std::vector<LinkTurn> links_;
};

}  // namespace virtual_work_dynamics
