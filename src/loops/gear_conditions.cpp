#include "loops/gear_conditions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/number_text.h"
#include "base/printable.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

// Wheels that are further from the distance of their radii do not mesh, relative to it.
constexpr double kNearEnough = 0.01;
// Sine of the angle between axes that count as parallel, and changes of a row or of the distance
// that count as none, relative to the radii.
constexpr double kParallelAxes = 1e-6;
constexpr double kConstant = 1e-6;
// Positions at which that is tried; rows are analytic functions of them.
constexpr int kPositions = 4;
std::vector<Condition> toothRow(const Closure& closure) {
  Condition row;
  row.name = closure.name + ".teeth";
  row.adopts_constant = true;
  return {row};
}

[[noreturn]] void refuse(const std::string& place, const std::string& what) {
  throw SceneError(place + ": " + what);
}

}  // namespace

GearConditions::GearConditions(const Mechanism& mechanism, const Closure& closure,
                               const Frame& parent, const Frame& child,
                               const std::vector<PathStep>& path,
                               const std::vector<int>& coordinates)
    : ClosureConditions(mechanism, closure, toothRow(closure), parent, child, path, coordinates),
      teeth_{closure.type == ClosureType::kRack,
             closure.teeth.parent_radius,
             closure.type == ClosureType::kRack ? 0 : closure.teeth.child_radius,
             std::tan(closure.teeth.pressure_angle) / std::cos(closure.teeth.helix_angle),
             std::tan(closure.teeth.helix_angle),
             this->coordinates().data(),
             nullptr,
             static_cast<int>(this->coordinates().size())} {
  setShape(teeth_);
  LinkKinematics links(mechanism);
  Eigen::VectorXd q =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(mechanism.coordinates().size()));
  for (int n = 0; n < kPositions; ++n) {
    links.setPosition(q);
    check(mechanism, links);
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      q[i] = 2.9 * std::sin(1.3 * n + 2.1 * static_cast<double>(i) + 0.7);
    }
  }
  teeth_.factors = factors_.data();
}

// Sets the row at the first position. Where the wheels keep their distance and nothing moves them
// apart in others, it is the same there.
void GearConditions::check(const Mechanism& mechanism, const LinkKinematics& links) {
  const FramePair frames = framesAt(links);
  const double radius = std::max(std::abs(teeth_.parent_radius), std::abs(teeth_.child_radius));
  const Eigen::Vector3d axis = frames.R_P.col(2), r = frames.Co - frames.Po;
  const Eigen::Vector3d other = teeth_.is_rack ? frames.R_C.col(0) : frames.R_C.col(2);
  const double off = teeth_.is_rack ? std::abs(axis.dot(other)) : axis.cross(other).norm();
  if (!(off <= kParallelAxes)) {
    refuse(place(), teeth_.is_rack ? "the rack's x is not normal to the wheel's axis z"
                                   : "the wheels' axes z are not parallel, or do not stay so");
  }
  Eigen::Vector3d across = r - r.dot(axis) * axis;
  if (teeth_.is_rack) across -= across.dot(other) * other;
  const double wanted = std::abs(teeth_.parent_radius + teeth_.child_radius);
  if (!(std::abs(across.norm() - wanted) <= kNearEnough * wanted)) {
    refuse(place(),
           std::string(teeth_.is_rack ? "the wheel's centre and the rack's line" : "the centres") +
               " are " + numberText(across.norm()) + " m apart, " + numberText(wanted) +
               " m by the " + (teeth_.is_rack ? "radius" : "radii"));
  }
  Mesh mesh;
  static_assert(sizeof(Mesh) == kMeshNumbers * sizeof(double), "plain numbers");
  kernel().findMesh(shape(), frames.R_P.data(), mesh.lever.data());
  const bool first = factors_.empty();
  if (first) factors_.resize(coordinates().size());
  for (std::size_t i = 0; i < factors_.size(); ++i) {
    const int coordinate = coordinates()[i];
    double row = 0, radial = 0, axial = 0;
    for (const PathStep& step : path()) {
      if (links.coordinateOf(step) != coordinate) continue;
      const Eigen::Vector3d moved = links.movedBy(step, frames.Co + mesh.lever).origin;
      row += mesh.along.dot(moved);  // (3.3)
      radial += mesh.away.dot(moved);
      axial += mesh.axis.dot(moved);
    }
    if (first) factors_[i] = row;
    const double size = std::max(radius, std::abs(row));
    if (std::abs(radial) > kConstant * size ||
        (teeth_.axial != 0 && std::abs(axial) > kConstant * size)) {
      refuse(place(),
             "joint " + inQuotes(mechanism.jointOf(coordinate).name) + " does not only turn " +
                 (teeth_.is_rack ? "the wheel or slide the rack" : "a wheel about its axis"));
    }
  }
}

void GearConditions::setPosition(const LoopState& state, ConditionRows rows) const {
  ClosureConditions::setPosition(state, rows);
  kernel().sumTurns(teeth_, state.q.data(), &rows.phi(0), &rows.rounding(0));
}

}  // namespace virtual_work_dynamics
