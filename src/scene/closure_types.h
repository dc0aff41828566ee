#pragma once

#include <array>
#include <optional>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// What a closure demands of its parent frame P and its child frame C.
struct ClosureCondition {
  enum class Kind {
    kAlong,    ///< the origins do not part along axis a of P
    kNormal,   ///< axis a of P stays normal to axis b of C
    kDistance  ///< the origins keep their distance
  };
  Kind kind = Kind::kDistance;
  int a = 0, b = 0;
};

/// A type of closure.
struct ClosureTypeTraits {
  ClosureType type;
  const char* name;  ///< as in a scene
  /// What the motion along or about its one free axis measures, z of P; not given: it has none, or
  /// more than one.
  std::optional<Unit> free_axis;
  int conditions;  ///< how many of the following it has
  std::array<ClosureCondition, 6> demands;

  int count(ClosureCondition::Kind kind) const;
  bool hasLength() const { return count(ClosureCondition::Kind::kDistance) > 0; }
  bool canTurn() const { return count(ClosureCondition::Kind::kNormal) < 3; }
};

constexpr std::size_t kClosureTypeCount = 8;
/// All types.
const std::array<ClosureTypeTraits, kClosureTypeCount>& closureTypes();
const ClosureTypeTraits& traitsOf(ClosureType type);

}  // namespace virtual_work_dynamics
