#include "scene/closure_types.h"

#include <algorithm>

namespace virtual_work_dynamics {

namespace {

using Kind = ClosureCondition::Kind;
using Type = ClosureType;

constexpr ClosureCondition kX{Kind::kAlong, 0, 0}, kY{Kind::kAlong, 1, 0}, kZ{Kind::kAlong, 2, 0};
// Axes of P and C: what keeps both z alike, what then keeps the frames from turning about z, and
// what a universal joint's cross does.
constexpr ClosureCondition kXz{Kind::kNormal, 0, 2}, kYz{Kind::kNormal, 1, 2};
constexpr ClosureCondition kXy{Kind::kNormal, 0, 1};
constexpr ClosureCondition kZx{Kind::kNormal, 2, 0};
constexpr ClosureCondition kRod{Kind::kDistance, 0, 0};

constexpr auto kNone = std::nullopt;

// The order of conditions is that of their multipliers.
constexpr std::array<ClosureTypeTraits, kClosureTypeCount> kTypes{
    {{Type::kFixed, "fixed", kNone, 6, {kX, kY, kZ, kXz, kYz, kXy}},
     {Type::kRevolute, "revolute", Unit::kRadian, 5, {kX, kY, kZ, kXz, kYz}},
     {Type::kPrismatic, "prismatic", Unit::kMetre, 5, {kX, kY, kXz, kYz, kXy}},
     {Type::kCylindrical, "cylindrical", kNone, 4, {kX, kY, kXz, kYz}},
     {Type::kUniversal, "universal", kNone, 4, {kX, kY, kZ, kZx}},
     {Type::kSpherical, "spherical", kNone, 3, {kX, kY, kZ}},
     {Type::kPlanar, "planar", kNone, 3, {kZ, kXz, kYz}},
     {Type::kDistance, "distance", kNone, 1, {kRod}}}};

}  // namespace

int ClosureTypeTraits::count(ClosureCondition::Kind kind) const {
  return static_cast<int>(
      std::count_if(demands.begin(), demands.begin() + conditions,
                    [&](const ClosureCondition& demand) { return demand.kind == kind; }));
}

const std::array<ClosureTypeTraits, kClosureTypeCount>& closureTypes() {
  return kTypes;
}

const ClosureTypeTraits& traitsOf(ClosureType type) {
  return *std::find_if(kTypes.begin(), kTypes.end(),
                       [&](const ClosureTypeTraits& traits) { return traits.type == type; });
}

}  // namespace virtual_work_dynamics
