#pragma once

#include <array>
#include <optional>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// What a closure demands of its parent frame P and its child frame C.
struct ClosureDemand {
  enum class Kind {
    kAlong,     ///< the origins coincide along axis a of P
    kNormal,    ///< axis a of P stays normal to axis b of C
    kDistance,  ///< the origins keep their distance
    kTouch,     ///< what touches a plane does not move along a direction: see TouchConditions
    kTeeth      ///< wheels, or a wheel and a rack, roll on each other: see GearConditions
  };
  Kind kind = Kind::kDistance;
  int a = 0, b = 0;
};

/// What distinguishes a type of closure.
struct ClosureTypeTraits {
  ClosureType type;
  const char* list;  ///< of the scene, that such closures stand in
  const char* name;  ///< as in a scene
  /// Unit of the motion along or about its one free axis, z of P; empty when it has no free axis or
  /// more than one.
  std::optional<Unit> free_axis;
  int conditions;  ///< how many of `demands` it has; what touches has as many as Touch says
  std::array<ClosureDemand, 6> demands;

  int count(ClosureDemand::Kind kind) const;
  bool hasLength() const { return count(ClosureDemand::Kind::kDistance) > 0; }
  /// Whether it joins a plane and what touches it in a point.
  bool touches() const { return count(ClosureDemand::Kind::kTouch) > 0; }
  /// Whether it is of teeth that mesh, between bodies that joints hold.
  bool meshes() const { return count(ClosureDemand::Kind::kTeeth) > 0; }
  bool canTurn() const { return count(ClosureDemand::Kind::kNormal) < 3; }
};

/// All types of closures.
const std::vector<ClosureTypeTraits>& closureTypes();
/// The entry of closureTypes() for a type.
const ClosureTypeTraits& traitsOf(ClosureType type);

}  // namespace virtual_work_dynamics
