#include <algorithm>
#include <cmath>
#include <limits>

#include "algebra/cone_program.h"

// The simplex method of ConeProgram, from corner to corner.
namespace virtual_work_dynamics {

namespace {

constexpr double kNowhere = std::numeric_limits<double>::infinity();
// After so many exchanges the inverse is made anew.
constexpr int kMostExchanges = 16;

}  // namespace

double ConeProgram::combined(const Plane& plane, double normal, double x, double y) const {
  if (plane.side < 0) return normal;
  const auto side = static_cast<std::size_t>(plane.side);
  return cones_[plane.cone].friction * normal - cosines_[side] * x - sines_[side] * y;
}

// The combination of coefficients that must not be negative.
void ConeProgram::setPlane(const Plane& plane, RowOfPlane row) const {
  const Cone& cone = cones_[plane.cone];
  const Eigen::Index count = row.size();
  const auto coefficients = [&](Eigen::Index function) {
    return reduced_.row(function).segment(1, count).transpose();
  };
  row = coefficients(cone.normal);
  if (plane.side < 0) return;
  const auto side = static_cast<std::size_t>(plane.side);
  row *= cone.friction;
  row -= cosines_[side] * coefficients(cone.along);
  if (cone.count == 2) row -= sines_[side] * coefficients(cone.along + 1);
}

double ConeProgram::valueOf(Eigen::Index function) const {
  return reduced_(function, 0) + reduced_.row(function).segment(1, rank_).dot(y_.head(rank_));
}

// The side of a cone that a force along the plane is the furthest outside of.
ConeProgram::Plane ConeProgram::sideTowards(std::size_t cone, double x, double y) const {
  if (cones_[cone].count == 1) return {cone, x < 0 ? kSides / 2 : 0};
  const int side =
      side_step_ * static_cast<int>(std::lround(std::atan2(y, x) / (kSideAngle * side_step_)));
  return {cone, (side + kSides) % kSides};
}

// Inverts the corner's planes anew, by Gauss and Jordan.
bool ConeProgram::refresh() {
  auto own = own_.topLeftCorner(rank_, rank_);
  auto inverse = inverse_.topLeftCorner(rank_, rank_);
  for (Eigen::Index i = 0; i < rank_; ++i) {
    setPlane(corner_[static_cast<std::size_t>(i)], own.row(i).transpose());
  }
  inverse.setIdentity();
  for (Eigen::Index j = 0; j < rank_; ++j) {
    Eigen::Index pivot = 0;
    const double size = own.col(j).tail(rank_ - j).cwiseAbs().maxCoeff(&pivot);
    if (!(size > kNoCoefficient * kNoCoefficient)) return false;
    own.row(j).swap(own.row(j + pivot));
    inverse.row(j).swap(inverse.row(j + pivot));
    const double by = own(j, j);
    own.row(j) /= by;
    inverse.row(j) /= by;
    for (Eigen::Index i = 0; i < rank_; ++i) {
      const double factor = own(i, j);
      if (i == j || factor == 0) continue;
      own.row(i) -= factor * own.row(j);
      inverse.row(i) -= factor * inverse.row(j);
    }
  }
  exchanges_ = 0;
  placeCorner();
  return true;
}

void ConeProgram::placeCorner() {
  auto y = y_.head(rank_);
  y.setZero();
  for (Eigen::Index i = 0; i < rank_; ++i) {
    const Plane& plane = corner_[static_cast<std::size_t>(i)];
    const Cone& cone = cones_[plane.cone];
    const double value =
        combined(plane, reduced_(cone.normal, 0), cone.count > 0 ? reduced_(cone.along, 0) : 0,
                 cone.count > 1 ? reduced_(cone.along + 1, 0) : 0);
    y -= value * inverse_.col(i).head(rank_);
  }
}

// Puts a plane, with factors_ that combine it from the corner's, in the place of one of these.
bool ConeProgram::exchange(Eigen::Index place, const Plane& plane) {
  corner_[static_cast<std::size_t>(place)] = plane;
  if (++exchanges_ >= kMostExchanges) return refresh();
  auto inverse = inverse_.topLeftCorner(rank_, rank_);
  inverse.col(place) /= factors_[place];
  for (Eigen::Index j = 0; j < rank_; ++j) {
    if (j != place && factors_[j] != 0) inverse.col(j) -= factors_[j] * inverse.col(place);
  }
  placeCorner();
  return true;
}

ConeProgram::Met ConeProgram::mostViolated() const {
  Met worst;
  const auto take = [&](const Plane& plane, double value) {
    if (value < std::min(-tolerance(), worst.value)) worst = {plane, value, 0, true};
  };
  for (std::size_t c = 0; c < cones_.size(); ++c) {
    const Cone& cone = cones_[c];
    const double normal = valueOf(cone.normal);
    take({c, -1}, normal);
    if (cone.count == 0) continue;
    const double x = valueOf(cone.along), y = cone.count > 1 ? valueOf(cone.along + 1) : 0;
    const Plane side = sideTowards(c, x, y);
    take(side, combined(side, normal, x, y));
  }
  return worst;
}

// The plane of a cone that the edge meets first.
ConeProgram::Met ConeProgram::meetCone(std::size_t c) const {
  const Cone& cone = cones_[c];
  const double normal = valueOf(cone.normal), to_normal = rates_[cone.normal];
  const auto first = [&](const Met& a, const Met& b) {
    return (std::max(0.0, a.value) + tolerance()) * -b.rate <
           (std::max(0.0, b.value) + tolerance()) * -a.rate;
  };
  Met met{{c, -1}, normal, to_normal, to_normal < -kNoCoefficient};
  if (cone.count == 0) return met;
  const double x = valueOf(cone.along), to_x = rates_[cone.along];
  const double y = cone.count > 1 ? valueOf(cone.along + 1) : 0;
  const double to_y = cone.count > 1 ? rates_[cone.along + 1] : 0;
  // Far away the side that the edge leads to; then, where the edge meets it, what is further out.
  Plane side = sideTowards(c, to_x, to_y);
  for (int round = 0; round < kSides; ++round) {
    const Met next{side, combined(side, normal, x, y), combined(side, to_normal, to_x, to_y), true};
    if (next.rate >= -kNoCoefficient || (met.found && !first(next, met))) break;
    met = next;
    const double way = (std::max(0.0, met.value) + tolerance()) / -met.rate;
    side = sideTowards(c, x + way * to_x, y + way * to_y);
    if (side.side == met.plane.side) break;
  }
  return met;
}

// The plane that the edge meets first; of those that it meets as early but for tolerances, the one
// that it meets at the steepest angle.
ConeProgram::Met ConeProgram::blocking(bool by_number) {
  for (Eigen::Index i = 0; i < functions_; ++i) {
    rates_[i] = reduced_.row(i).segment(1, rank_).dot(edge_.head(rank_));
  }
  double bound = kNowhere;
  met_.clear();
  for (std::size_t c = 0; c < cones_.size(); ++c) {
    const Met met = meetCone(c);
    met_.push_back(met);
    if (met.found) bound = std::min(bound, (std::max(0.0, met.value) + tolerance()) / -met.rate);
  }
  Met best;
  for (const Met& met : met_) {
    if (!met.found || met.value / -met.rate > bound) continue;
    const bool better = by_number ? met.plane < best.plane : met.rate < best.rate;
    if (!best.found || better) best = met;
  }
  return best;
}

// Until no plane is violated, while the objective stays at its least: the dual simplex method.
ConeProgram::Step ConeProgram::restore() {
  const Eigen::Index most = 50 * (rank_ + static_cast<Eigen::Index>(cones_.size())) + 100;
  for (Eigen::Index step = 0; step < most; ++step) {
    const Met out = mostViolated();
    if (!out.found) return Step::kDone;
    auto factors = factors_.head(rank_), multipliers = multipliers_.head(rank_);
    setPlane(out.plane, edge_.head(rank_));
    factors.noalias() = inverse_.topLeftCorner(rank_, rank_).transpose() * edge_.head(rank_);
    multipliers.noalias() =
        inverse_.topLeftCorner(rank_, rank_).transpose() * objective_.head(rank_);
    double bound = kNowhere;
    for (Eigen::Index j = 0; j < rank_; ++j) {
      if (factors[j] <= kNoCoefficient) continue;
      bound = std::min(bound, (std::max(0.0, multipliers[j]) + kNoCoefficient) / factors[j]);
    }
    Eigen::Index best = -1;
    for (Eigen::Index j = 0; j < rank_; ++j) {
      if (factors[j] <= kNoCoefficient || multipliers[j] / factors[j] > bound) continue;
      if (best < 0 || factors[j] > factors[best]) best = j;
    }
    if (best < 0) {
      if (exchanges_ == 0) {
        const double by_rounding = factors.cwiseMax(0.0).sum() * kMostScales * scale_;
        return out.value + by_rounding < 0 ? Step::kInfeasible : Step::kStuck;
      }
      if (!refresh()) return Step::kStuck;
      continue;
    }
    if (!exchange(best, out.plane)) return Step::kStuck;
  }
  return Step::kStuck;
}

// Until the objective is at its least: the simplex method, from a corner where no plane is
// violated.
ConeProgram::Step ConeProgram::improve() {
  const Eigen::Index usual = 10 * (rank_ + static_cast<Eigen::Index>(cones_.size())) + 50;
  for (Eigen::Index step = 0; step < 10 * usual; ++step) {
    const bool by_number = step > usual;
    auto multipliers = multipliers_.head(rank_);
    multipliers.noalias() =
        inverse_.topLeftCorner(rank_, rank_).transpose() * objective_.head(rank_);
    Eigen::Index best = -1;
    for (Eigen::Index j = 0; j < rank_; ++j) {
      if (multipliers[j] >= -kNoCoefficient) continue;
      const bool better =
          best < 0 || (by_number ? corner_[std::size_t(j)] < corner_[std::size_t(best)]
                                 : multipliers[j] < multipliers[best]);
      if (better) best = j;
    }
    if (best < 0) {
      if (exchanges_ == 0) return Step::kDone;
      if (!refresh()) return Step::kStuck;
      const Step again = restore();
      if (again != Step::kDone) return again;
      continue;
    }
    edge_.head(rank_) = inverse_.col(best).head(rank_);
    const Met met = blocking(by_number);
    if (!met.found) return Step::kUnbounded;
    setPlane(met.plane, edge_.head(rank_));
    factors_.head(rank_).noalias() =
        inverse_.topLeftCorner(rank_, rank_).transpose() * edge_.head(rank_);
    if (!exchange(best, met.plane)) return Step::kStuck;
  }
  return Step::kStuck;
}

}  // namespace virtual_work_dynamics
