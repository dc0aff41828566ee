#include "loops/driven_conditions.h"

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

#include "base/printable.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

constexpr double kTurn = 6.283185307179586476925286766559;

std::vector<Condition> axisRow(const std::string& name, Unit unit) {
  Condition row;
  row.name = name;
  row.unit = unit;
  row.drives = true;
  return {row};
}

std::vector<Condition> poseRows(const std::string& link) {
  std::vector<Condition> rows;
  for (const Unit unit : {Unit::kMetre, Unit::kRadian}) {
    for (const char* axis : {"x", "y", "z"}) {
      rows.push_back(axisRow("pose." + link + (unit == Unit::kMetre ? "." : ".r") + axis, unit)[0]);
    }
  }
  return rows;
}

const std::string& nameOf(const Mechanism& mechanism, int link) {
  return mechanism.links()[static_cast<std::size_t>(link)].name;
}

// A quaternion's four numbers, in Eigen's order.
Eigen::Quaterniond quaternionAt(const Eigen::VectorXd& numbers, Eigen::Index first) {
  return Eigen::Quaterniond(Eigen::Vector4d(numbers.segment<4>(first)));
}

}  // namespace

FreeAxisDrive::FreeAxisDrive(const std::string& name, const ClosureConditions& closure,
                             Eigen::Index number)
    : ConditionSet("the free axis of closure " + inQuotes(name),
                   axisRow(name + ".free", closure.freeUnit()), closure.coordinates()),
      closure_(closure),
      number_(number) {}

void FreeAxisDrive::setPosition(const LoopState& state, ConditionRows rows) const {
  const LinkKinematics& links = state.links;
  FramePair& frames = rows.frames();
  frames = closure_.framesAt(links);
  const double off = closure_.freePosition(frames) - state.driven.q[number_];
  // Whole turns make no difference to a pin.
  const bool slides = closure_.freeUnit() == Unit::kMetre;
  rows.phi(0) = slides ? off : std::remainder(off, kTurn);  // (3.3)
  for (const int coordinate : coordinates()) rows.A(0, coordinate) = 0;
  for (const PathStep& step : closure_.path()) {
    const int coordinate = links.coordinateOf(step);
    if (coordinate < 0) continue;
    const LinkKinematics::Displacement moved = links.movedBy(step, frames.Co);
    rows.A(0, coordinate) += frames.R_P.col(2).dot(slides ? moved.origin : moved.turn);  // (3.3)
  }
}

void FreeAxisDrive::setMotion(const LoopState& state, ConditionRows rows) const {
  rows.turning(0) = closure_.freeAcceleration(state.links, rows.frames());
  rows.b(0) = -state.driven.qd[number_];  // (3.2)
  rows.bd(0) = -state.driven.qdd[number_];
}

PoseDrive::PoseDrive(const Mechanism& mechanism, int link, Eigen::Index number)
    : PoseDrive(nameOf(mechanism, link), link, pathBetween(mechanism, 0, link),
                coordinatesOn(mechanism, pathBetween(mechanism, 0, link)), number) {
  if (coordinates().empty()) throw SceneError(place() + ": no joint moves the link");
}

PoseDrive::PoseDrive(const std::string& link_name, int link, std::vector<PathStep> path,
                     std::vector<int> coordinates, Eigen::Index number)
    : ConditionSet("the pose of link " + inQuotes(link_name), poseRows(link_name),
                   std::move(coordinates)),
      frame_{link, Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()},
      path_(std::move(path)),
      number_(number) {}

// Phi is the way from the origin that is given, and the axis times the sine of the angle from the
// axes that are given.
void PoseDrive::setPosition(const LoopState& state, ConditionRows rows) const {
  const LinkKinematics& links = state.links;
  const Eigen::Vector3d o = links.originOf(frame_);
  const Eigen::Vector3d way = o - state.driven.q.segment<3>(number_);
  const Eigen::Matrix3d R =
      quaternionAt(state.driven.q, number_ + 3).normalized().toRotationMatrix();
  const Eigen::Matrix3d& axes = links.axesOf(frame_.link);
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) turn += 0.5 * R.col(i).cross(axes.col(i));
  for (int i = 0; i < 3; ++i) {
    rows.phi(i) = way[i];  // (3.3)
    rows.phi(3 + i) = turn[i];
  }
  for (const int coordinate : coordinates()) {
    for (int i = 0; i < 6; ++i) rows.A(i, coordinate) = 0;
  }
  for (const PathStep& step : path_) {
    const int coordinate = links.coordinateOf(step);
    if (coordinate < 0) continue;
    const LinkKinematics::Displacement moved = links.movedBy(step, o);
    for (int i = 0; i < 3; ++i) {
      rows.A(i, coordinate) += moved.origin[i];
      rows.A(3 + i, coordinate) += moved.turn[i];
    }
  }
}

void PoseDrive::setMotion(const LoopState& state, ConditionRows rows) const {
  const LinkKinematics::PointMotion at =
      state.links.motionAt(frame_.link, state.links.originOf(frame_));
  const Motion& driven = state.driven;
  // With u = Qd Q^-1 of a quaternion Q of any length: w = 2 Im u, alpha = 2 Im(Qdd Q^-1 - u u).
  const Eigen::Quaterniond inverse = quaternionAt(driven.q, number_ + 3).inverse();
  const Eigen::Quaterniond u = quaternionAt(driven.qd, number_ + 3) * inverse;
  const Eigen::Quaterniond ud = quaternionAt(driven.qdd, number_ + 3) * inverse;
  const Eigen::Vector3d w = 2 * u.vec(), alpha = 2 * (ud.vec() - 2 * u.w() * u.vec());
  for (int i = 0; i < 3; ++i) {
    rows.b(i) = -driven.qd[number_ + i];  // (3.2)
    rows.bd(i) = -driven.qdd[number_ + i];
    rows.b(3 + i) = -w[i];
    rows.bd(3 + i) = -alpha[i];
    rows.turning(i) = at.a[i];
    rows.turning(3 + i) = at.alpha[i];
  }
}

}  // namespace virtual_work_dynamics
