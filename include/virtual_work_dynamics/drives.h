#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "virtual_work_dynamics/given.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// The drives of a scene: rheonomic conditions Phi(q, t) = 0 (3.3), each of one coordinate or one
/// free axis of a closure, whose A qd + b = 0 (3.2) has b = -dPhi/dt. They put the motion of what
/// is driven into motions; that of the rest follows from the closures, as for anything that is
/// given. Serves one thread.
class Drives {
 public:
  /// @throws SceneError naming the drive and what is wrong: a name that is neither that of a joint
  ///   that moves by itself nor of a closure with one free axis, or is given twice; numbers that
  ///   are no function of time; and where that jumps, in position, velocity or acceleration.
  Drives(const Mechanism& mechanism, const Scene& scene);
  ~Drives();
  Drives(Drives&&) noexcept;
  Drives& operator=(Drives&&) noexcept;

  bool empty() const { return names_.empty(); }
  /// By drive: what it drives.
  const std::vector<std::string>& names() const { return names_; }
  /// Whether each generalized coordinate is driven.
  const std::vector<bool>& coordinates() const { return coordinates_; }
  /// Closures that are driven, by index in the scene.
  const std::vector<std::size_t>& closures() const { return closures_; }

  /// Sets what is driven at a time. Rates are zero in static scenes. Does not allocate.
  /// @param t s
  /// @param given what the motion gives, drives included
  /// @param motion of all coordinates
  /// @param driven the driven numbers of `given`
  /// @returns why there is no motion at that time: the drive that has ended or not begun; or
  ///   nothing
  std::optional<std::size_t> evaluate(double t, const Given& given, Motion& motion, Motion& driven);
  /// Says in one line why there is no motion at a time. Allocates.
  /// @param drive as evaluate() returned it
  std::string whyNone(std::size_t drive, double t) const;

 private:
  struct Target;

  std::vector<std::string> names_;
  std::vector<bool> coordinates_;
  std::vector<std::size_t> closures_;
  std::vector<Target> targets_;  // by drive
  bool static_motion_;
  Motion now_;  // of one drive
};

}  // namespace virtual_work_dynamics
