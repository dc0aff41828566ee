#include "scene/closure_types.h"

#include <algorithm>

namespace virtual_work_dynamics {

namespace {

using Kind = ClosureDemand::Kind;
using Type = ClosureType;

constexpr ClosureDemand kX{Kind::kAlong, 0, 0}, kY{Kind::kAlong, 1, 0}, kZ{Kind::kAlong, 2, 0};
// Normal axes of P and C: kXz and kYz keep both z axes parallel, kXy then keeps the frames from
// turning about z, and kZx is the cross of a universal joint.
constexpr ClosureDemand kXz{Kind::kNormal, 0, 2}, kYz{Kind::kNormal, 1, 2};
constexpr ClosureDemand kXy{Kind::kNormal, 0, 1};
constexpr ClosureDemand kZx{Kind::kNormal, 2, 0};
constexpr ClosureDemand kRod{Kind::kDistance, 0, 0};
constexpr ClosureDemand kForce{Kind::kTouch, 0, 0};
constexpr ClosureDemand kTooth{Kind::kTeeth, 0, 0};

constexpr auto kNone = std::nullopt;

}  // namespace

int ClosureTypeTraits::count(ClosureDemand::Kind kind) const {
  return static_cast<int>(
      std::count_if(demands.begin(), demands.begin() + conditions,
                    [&](const ClosureDemand& demand) { return demand.kind == kind; }));
}

// The order of conditions is that of their multipliers.
const std::vector<ClosureTypeTraits>& closureTypes() {
  static const std::vector<ClosureTypeTraits> types = {
      {Type::kFixed, "closures", "fixed", kNone, 6, {kX, kY, kZ, kXz, kYz, kXy}},
      {Type::kRevolute, "closures", "revolute", Unit::kRadian, 5, {kX, kY, kZ, kXz, kYz}},
      {Type::kPrismatic, "closures", "prismatic", Unit::kMetre, 5, {kX, kY, kXz, kYz, kXy}},
      {Type::kCylindrical, "closures", "cylindrical", kNone, 4, {kX, kY, kXz, kYz}},
      {Type::kUniversal, "closures", "universal", kNone, 4, {kX, kY, kZ, kZx}},
      {Type::kSpherical, "closures", "spherical", kNone, 3, {kX, kY, kZ}},
      {Type::kPlanar, "closures", "planar", kNone, 3, {kZ, kXz, kYz}},
      {Type::kDistance, "closures", "distance", kNone, 1, {kRod}},
      {Type::kGear, "closures", "gear", kNone, 1, {kTooth}},
      {Type::kRack, "closures", "rack", kNone, 1, {kTooth}},
      {Type::kCylinder, "cylinders", "cylinder", Unit::kMetre, 0, {}},
      {Type::kRolling, "rolling", "rolling", kNone, 3, {kForce, kForce, kForce}},
      {Type::kKnifeEdge, "knife_edges", "knife_edge", kNone, 2, {kForce, kForce}},
      {Type::kContact, "contacts", "contact", kNone, 3, {kForce, kForce, kForce}}};
  return types;
}

const ClosureTypeTraits& traitsOf(ClosureType type) {
  return *std::find_if(closureTypes().begin(), closureTypes().end(),
                       [&](const ClosureTypeTraits& traits) { return traits.type == type; });
}

}  // namespace virtual_work_dynamics
