#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "loops/forces.h"
#include "loops/kinematics.h"
#include "virtual_work_dynamics/results.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Whether forces act as what makes them can: contacts press and have friction cones, cables pull.
/// Immutable.
class LoopHolds {
 public:
  LoopHolds(const Scene& scene, const LoopKinematics& kinematics,
            const std::vector<LoopGroup>& groups);

  /// What acts one way.
  struct Item {
    std::size_t group, local;    // of its closure
    int acting;                  // its unknown that acts one way
    double sign;                 // of that unknown
    int along_begin, along_end;  // its unknowns along the plane
    std::optional<double> friction;
  };

  const std::vector<std::string>& names() const { return names_; }
  /// By name.
  const std::vector<Item>& items() const { return items_; }
  /// Judges the solutions of all groups. Does not allocate.
  void judge(std::vector<LoopForces>& forces, std::vector<Hold>& holds) const;

  /// Forces of a group in a sample among those of a pack, of which `width` neighbouring numbers
  /// belong together.
  struct Packed {
    const double* x;
    /// Parts in the null space of the item's unknowns along the plane, then of the one that acts;
    /// null where all are determined.
    const double* null_squares;
    double largest;  ///< of x, absolute
    std::size_t width, sample;
  };
  static Hold judge(const LoopForces& forces, const Item& item, const Packed& packed);

 private:
  static Hold judge(LoopForces& forces, const Item& item);

  std::vector<std::string> names_;
  std::vector<Item> items_;
};

}  // namespace virtual_work_dynamics
