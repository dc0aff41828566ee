#include "loops/nearest_closing.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/closure_types.h"

namespace virtual_work_dynamics {

namespace {

using Matrix3 = Eigen::Matrix3d;
using Vector3 = Eigen::Vector3d;

// Misfit below which Newton's method on the conditions themselves finds the rest of the way.
constexpr double kClosedMisfit = 1e-11;
// Longest step of a coordinate, rad or of the length: short, so that the way is nearly continuous.
constexpr double kLongestSearchStep = 0.15;
constexpr int kMostSteps = 200;
// Damping: of the squares of unit columns, at first, at least, and where a descent has failed.
constexpr double kDamping = 1e-4, kLeastDamping = 1e-14, kMostDamping = 1e8;
// A solution closer to the start than this is near enough, rad or of the length.
constexpr double kNear = 0.02;
// Further descents: many where they cost little; in large mechanisms few, and only where the first
// one leaves the loops open.
constexpr int kAttempts = 32, kFewAttempts = 4;
constexpr std::size_t kManyCoordinates = 60;
// Where nothing is closed yet, they set out from up to so far.
constexpr double kLargestDisplacement = 1.5;
// Squared sine below which two directions count as parallel.
constexpr double kParallel = 1e-24;

Vector3 anyNormal(const Vector3& v) {
  return v.unitOrthogonal();
}

}  // namespace

// Misfits and their Jacobian for the moving coordinates.
struct NearestClosing::System {
  explicit System(const std::vector<int>& coordinates, std::size_t all)
      : moving(coordinates), columns(all, -1) {
    for (std::size_t k = 0; k < moving.size(); ++k) {
      columns[static_cast<std::size_t>(moving[k])] = static_cast<int>(k);
    }
  }
  void clear() { rows = 0; }
  // Makes room for rows and returns the first.
  Eigen::Index add(Eigen::Index count) {
    const auto width = static_cast<Eigen::Index>(moving.size());
    if (misfits.size() < rows + count) {
      misfits.conservativeResize(rows + count);
      J.conservativeResize(rows + count, width);
    }
    misfits.segment(rows, count).setZero();
    if (width > 0) J.middleRows(rows, count).setZero();  // without columns it has no memory
    rows += count;
    return rows - count;
  }
  double misfit() const { return misfits.head(rows).norm(); }

  const std::vector<int>& moving;
  std::vector<int> columns;  // by coordinate of the mechanism
  Eigen::Index rows = 0;
  Eigen::VectorXd misfits;
  Eigen::MatrixXd J;
};

// A closed attempt is better than an open one, then that which moved less.
bool NearestClosing::Attempt::better(const Attempt& other) const {
  const bool closed = misfit <= kClosedMisfit, other_closed = other.misfit <= kClosedMisfit;
  if (closed != other_closed) return closed;
  return closed ? moved < other.moved : misfit < other.misfit;
}

NearestClosing::NearestClosing(LoopKinematics& kinematics, std::vector<LoopGroup> groups,
                               std::vector<double> scales, double length)
    : kinematics_(kinematics),
      groups_(std::move(groups)),
      scales_(std::move(scales)),
      length_(length) {}

// Rows for the closure: the vector between the origins and the turn between the axes, in axes that
// turn half as much as either frame, so that exchanging the frames changes no square.
void NearestClosing::addClosure(std::size_t c, System& system) const {
  const LinkKinematics& links = kinematics_.links();
  const ClosureConditions& closure = kinematics_.closure(c);
  const ClosureTypeTraits& traits = closure.traits();
  if (closure.type() == ClosureType::kCylinder) return;  // it demands nothing
  const Vector3 P = links.originOf(closure.parent()), C = links.originOf(closure.child());
  const Vector3 r = C - P;
  const Matrix3 A_P = links.axesOf(closure.parent()), A_C = links.axesOf(closure.child());
  // Adds rows W v(at) + T w with misfits, for the relative velocity v at a point and turn rate w.
  const auto add = [&](const Matrix3& along, const Matrix3& turn, const Vector3& at,
                       const Vector3& misfit) {
    const Eigen::Index first = system.add(3);
    system.misfits.segment<3>(first) = misfit;
    for (const PathStep& step : closure.path()) {
      const int coordinate = links.coordinateOf(step);
      if (coordinate < 0) continue;
      const int column = system.columns[static_cast<std::size_t>(coordinate)];
      if (column < 0) continue;
      const LinkKinematics::Displacement moved = links.movedBy(step, at);
      system.J.block<3, 1>(first, column) +=
          scale(coordinate) * (along * (moved.origin / length_) + turn * moved.turn);
    }
  };
  const Matrix3 zero = Matrix3::Zero(), one = Matrix3::Identity();
  const auto outer = [](const Vector3& a) -> Matrix3 { return a * a.transpose(); };
  const double half = std::sqrt(0.5);
  using Type = ClosureType;
  const Type type = closure.type();
  const Vector3 z_P = A_P.col(2), z_C = A_C.col(2);

  if (type == Type::kDistance) {
    const double distance = r.norm();
    if (!closure.length() || distance == 0) return;
    const Matrix3 along = Vector3::UnitX() * (r / distance).transpose();
    add(along, zero, C, {(distance - *closure.length()) / length_, 0, 0});
    return;
  }
  if (traits.count(ClosureDemand::Kind::kAlong) == 3) {
    add(one, zero, (P + C) / 2, r / length_);
  } else {
    const bool normal = type == Type::kPlanar;  // the origins stay in a plane, not on a line
    const auto across = [&](const Vector3& z) -> Matrix3 {
      return half * (normal ? outer(z) : one - outer(z));
    };
    add(across(z_P), zero, C, across(z_P) * r / length_);
    add(across(z_C), zero, P, across(z_C) * r / length_);
  }
  const int directions = traits.count(ClosureDemand::Kind::kNormal);
  if (directions == 1) {  // z of P stays normal to x of C
    const Vector3 x_C = A_C.col(0), n = x_C.cross(z_P);
    const double sine = z_P.dot(x_C), cosine = n.norm();
    const Vector3 axis = cosine > 0 ? Vector3(n / cosine) : anyNormal(z_P);
    add(zero, Vector3::UnitX() * axis.transpose(), C, {std::atan2(sine, cosine), 0, 0});
    return;
  }
  if (directions == 0) return;
  double angle = 0;
  Vector3 axis;
  if (directions == 3) {  // the turn that takes C's axes to P's
    const Eigen::AngleAxisd turn(Eigen::Quaterniond(Matrix3(A_P * A_C.transpose())));
    angle = turn.angle() > M_PI ? turn.angle() - 2 * M_PI : turn.angle();
    axis = turn.axis();
  } else {
    const Vector3 n = z_C.cross(z_P);
    angle = std::atan2(n.norm(), z_C.dot(z_P));
    axis = n.squaredNorm() > kParallel ? Vector3(n.normalized()) : anyNormal(z_C);
  }
  const double factor = std::abs(angle) > 1e-4 ? angle / 2 / std::sin(angle / 2) : 1;
  Matrix3 turn = outer(axis) + factor * (one - outer(axis));
  if (directions == 2) {  // the turn about the mean of both axes is free
    const Vector3 mean = z_C + z_P;
    const Vector3 free =
        mean.squaredNorm() > kParallel ? Vector3(mean.normalized()) : Vector3(z_C.cross(axis));
    turn = turn * (one - outer(free));
  }
  add(zero, turn, C, -angle * axis);
}

void NearestClosing::setSystem(const LoopGroup& group, const std::vector<int>& moving,
                               System& system) const {
  system.clear();
  for (const std::size_t s : group.sets) {
    if (s < kinematics_.closures() && !kinematics_.closure(s).traits().touches() &&
        !kinematics_.closure(s).traits().meshes()) {
      addClosure(s, system);
      continue;
    }
    for (Eigen::Index i = kinematics_.firstOf(s); i < kinematics_.firstOf(s + 1); ++i) {
      const Condition& condition = kinematics_.condition(i);
      if (!condition.has_position) continue;
      const double row_scale = 1 / scaleOf(condition.unit, length_);
      const Eigen::Index row = system.add(1);
      system.misfits[row] = row_scale * kinematics_.phi()[i];
      for (std::size_t k = 0; k < moving.size(); ++k) {
        system.J(row, static_cast<Eigen::Index>(k)) =
            row_scale * scale(moving[k]) * kinematics_.jacobian()(i, moving[k]);
      }
    }
  }
}

// Levenberg's and Marquardt's method in bounded steps.
NearestClosing::Attempt NearestClosing::descend(const LoopGroup& group,
                                                const Eigen::VectorXd& start,
                                                const Eigen::VectorXd& from,
                                                const std::vector<int>& moving) {
  const auto width = static_cast<Eigen::Index>(moving.size());
  System now(moving, scales_.size()), then = now;
  Attempt attempt;
  attempt.q = from;
  kinematics_.setPosition(attempt.q);
  setSystem(group, moving, now);
  double damping = kDamping;
  for (int steps = 0; steps < kMostSteps && now.misfit() > kClosedMisfit / 1e3; ++steps) {
    const auto J = now.J.topRows(now.rows);
    const Eigen::MatrixXd squares = J.transpose() * J;
    const Eigen::VectorXd slope = -(J.transpose() * now.misfits.head(now.rows));
    bool moved = false;
    while (!moved && damping < kMostDamping) {
      Eigen::MatrixXd damped = squares;
      damped.diagonal().array() += damping;
      Eigen::VectorXd step = damped.ldlt().solve(slope);
      double longest = 0;
      for (Eigen::Index k = 0; k < width; ++k) {
        const bool bends = kinematics_.bends(moving[static_cast<std::size_t>(k)]);
        if (bends) longest = std::max(longest, std::abs(step[k]));
      }
      if (longest > kLongestSearchStep) step *= kLongestSearchStep / longest;
      Eigen::VectorXd tried = attempt.q;
      for (Eigen::Index k = 0; k < width; ++k) {
        const int coordinate = moving[static_cast<std::size_t>(k)];
        tried[coordinate] += scale(coordinate) * step[k];
      }
      kinematics_.setPosition(tried);
      setSystem(group, moving, then);
      moved = then.misfit() < now.misfit();
      if (!moved) {
        damping = std::max(10 * damping, kDamping);
        continue;
      }
      damping = std::max(damping / 10, kLeastDamping);
      attempt.q = tried;
      std::swap(now.misfits, then.misfits);
      std::swap(now.J, then.J);
      std::swap(now.rows, then.rows);
    }
    if (!moved) break;
  }
  attempt.misfit = now.misfit();
  for (const int i : moving) {
    attempt.moved = std::hypot(attempt.moved, (attempt.q[i] - start[i]) / scale(i));
  }
  return attempt;
}

bool NearestClosing::closeGroup(const LoopGroup& group, Eigen::VectorXd& q,
                                const std::vector<bool>& given) {
  std::vector<int> moving;
  for (const int i : group.coordinates) {
    if (!given[static_cast<std::size_t>(i)]) moving.push_back(i);
  }
  const Eigen::VectorXd start = q;
  Attempt best = descend(group, start, start, moving);
  const bool many = scales_.size() > kManyCoordinates;
  const int attempts = many && best.misfit <= kClosedMisfit ? 0 : many ? kFewAttempts : kAttempts;
  Eigen::VectorXd shares(moving.size());
  for (int i = 0; i < attempts && (best.misfit > kClosedMisfit || best.moved > kNear); ++i) {
    // A nearer solution lies within the distance of the one at hand. Directions do not repeat.
    const double reach = best.misfit > kClosedMisfit ? kLargestDisplacement
                                                     : std::min(kLargestDisplacement, best.moved);
    for (Eigen::Index k = 0; k < shares.size(); ++k) {
      shares[k] = std::sin(1.0 + 2.1 * static_cast<double>(k) + 3.7 * i);
    }
    shares *= reach * (i + 1) / attempts / std::max(shares.norm(), 1.0);
    Eigen::VectorXd from = start;
    for (std::size_t k = 0; k < moving.size(); ++k) {
      from[moving[k]] += shares[static_cast<Eigen::Index>(k)] * scale(moving[k]);
    }
    const Attempt attempt = descend(group, start, from, moving);
    if (attempt.better(best)) best = attempt;
  }
  q = best.q;
  return best.misfit <= kClosedMisfit;
}

bool NearestClosing::close(Eigen::VectorXd& q, const std::vector<bool>& given) {
  bool closed = true;
  for (const LoopGroup& group : groups_) closed = closeGroup(group, q, given) && closed;
  kinematics_.setPosition(q);
  return closed;
}

}  // namespace virtual_work_dynamics
