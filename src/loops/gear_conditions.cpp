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
// Roundings of a sum, of its terms.
constexpr double kTurnRounding = 4 * std::numeric_limits<double>::epsilon();

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
      is_rack_(closure.type == ClosureType::kRack),
      parent_radius_(closure.teeth.parent_radius),
      child_radius_(is_rack_ ? 0 : closure.teeth.child_radius),
      radial_(std::tan(closure.teeth.pressure_angle) / std::cos(closure.teeth.helix_angle)),
      axial_(std::tan(closure.teeth.helix_angle)) {
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
}

FramePair GearConditions::framesOf(const LinkKinematics& links, const Frame& parent,
                                   const Frame& child) {
  return {links.axesOf(parent), links.axesOf(child), links.originOf(parent), links.originOf(child)};
}

// With the signed distance d of the centres, u = (Co - Po) / d points from the parent's centre to
// the pitch point where its teeth are outside, and the other way where they are inside. Radii are
// those of the centres as they are, in the ratio of the radii that are given.
GearConditions::Mesh GearConditions::meshOf(const FramePair& frames) const {
  Mesh mesh;
  mesh.axis = frames.R_P.col(2);
  const Eigen::Vector3d r = frames.Co - frames.Po;
  if (is_rack_) {
    const Eigen::Vector3d slide = frames.R_C.col(0);
    const Eigen::Vector3d across = r - r.dot(slide) * slide - r.dot(mesh.axis) * mesh.axis;
    mesh.away = across / std::copysign(across.norm(), parent_radius_);
    mesh.point = frames.Co - r.dot(slide) * slide;
  } else {
    const Eigen::Vector3d across = r - r.dot(mesh.axis) * mesh.axis;
    const double distance = parent_radius_ + child_radius_;
    mesh.away = across / std::copysign(across.norm(), distance);
    mesh.point = frames.Co - child_radius_ / distance * across;
  }
  mesh.along = mesh.axis.cross(mesh.away);
  return mesh;
}

// Sets the row at the first position. Where the wheels keep their distance and nothing moves them
// apart in others, it is the same there.
void GearConditions::check(const Mechanism& mechanism, const LinkKinematics& links) {
  const FramePair frames = framesOf(links, parent(), child());
  const double radius = std::max(std::abs(parent_radius_), std::abs(child_radius_));
  const Eigen::Vector3d axis = frames.R_P.col(2), r = frames.Co - frames.Po;
  const Eigen::Vector3d other = is_rack_ ? frames.R_C.col(0) : frames.R_C.col(2);
  const double off = is_rack_ ? std::abs(axis.dot(other)) : axis.cross(other).norm();
  if (!(off <= kParallelAxes)) {
    refuse(place(), is_rack_ ? "the rack's x is not normal to the wheel's axis z"
                             : "the wheels' axes z are not parallel, or do not stay so");
  }
  Eigen::Vector3d across = r - r.dot(axis) * axis;
  if (is_rack_) across -= across.dot(other) * other;
  const double wanted = std::abs(is_rack_ ? parent_radius_ : parent_radius_ + child_radius_);
  if (!(std::abs(across.norm() - wanted) <= kNearEnough * wanted)) {
    refuse(place(),
           std::string(is_rack_ ? "the wheel's centre and the rack's line" : "the centres") +
               " are " + numberText(across.norm()) + " m apart, " + numberText(wanted) +
               " m by the " + (is_rack_ ? "radius" : "radii"));
  }
  const Mesh mesh = meshOf(frames);
  const bool first = terms_.empty();
  if (first) {
    for (const int coordinate : coordinates()) terms_.push_back({coordinate, 0});
  }
  for (Term& term : terms_) {
    double row = 0, radial = 0, axial = 0;
    for (const PathStep& step : path()) {
      if (links.coordinateOf(step) != term.coordinate) continue;
      const Eigen::Vector3d moved = links.movedBy(step, mesh.point).origin;
      row += mesh.along.dot(moved);  // (3.3)
      radial += mesh.away.dot(moved);
      axial += mesh.axis.dot(moved);
    }
    if (first) term.factor = row;
    const double size = std::max(radius, std::abs(row));
    if (std::abs(radial) > kConstant * size ||
        (axial_ != 0 && std::abs(axial) > kConstant * size)) {
      refuse(place(), "joint " + inQuotes(mechanism.jointOf(term.coordinate).name) +
                          " does not only turn " +
                          (is_rack_ ? "the wheel or slide the rack" : "a wheel about its axis"));
    }
  }
}

void GearConditions::setPosition(const LoopState& state, ConditionRows rows) const {
  FramePair& frames = rows.frames();
  frames = framesOf(state.links, parent(), child());
  double sum = 0, size = 0;
  for (const Term& term : terms_) {
    const double part = term.factor * state.q[term.coordinate];
    sum += part;
    size += std::abs(part);
    rows.A(0, term.coordinate) = term.factor;  // (3.2)
  }
  rows.phi(0) = sum;  // (3.3)
  rows.rounding(0) = kTurnRounding * size;
  rows.unitWrench(0) = wrenchOf(1, false, frames);
}

ClosureWrench GearConditions::wrenchOf(double multiplier, bool reversed,
                                       const FramePair& frames) const {
  const Mesh mesh = meshOf(frames);
  ClosureWrench wrench;
  wrench.force =
      multiplier * (mesh.along + axial_ * mesh.axis + (reversed ? -radial_ : radial_) * mesh.away);
  wrench.moment = (mesh.point - frames.Co).cross(wrench.force);
  return wrench;
}

}  // namespace virtual_work_dynamics
