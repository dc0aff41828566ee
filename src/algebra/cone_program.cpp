#include "algebra/cone_program.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace virtual_work_dynamics {

namespace {

// Values below this fraction of the scale are zero.
constexpr double kZero = 1e-10;
// Coefficients and multipliers below this are rounding errors.
constexpr double kNoCoefficient = 1e-9;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Values of this many scales are none that forces have.
constexpr double kMostScales = 1000;
constexpr double kSideAngle = 2 * M_PI / ConeProgram::kSides;
constexpr int kQuarter = ConeProgram::kSides / 4;
// Corners of pyramids with fewer sides lead close to a least value, with fewer steps.
constexpr int kCoarse = ConeProgram::kSides / 16;
// After so many exchanges the inverse is made anew.
constexpr int kMostExchanges = 16;

}  // namespace

ConeProgram::ConeProgram(Eigen::Index most_variables, Eigen::Index most_functions,
                         std::size_t most_cones)
    : most_variables_(most_variables),
      start_rows_(5 * static_cast<Eigen::Index>(most_cones), most_variables + 1),
      table_(most_functions, most_variables + 1),
      reduced_(most_functions, most_variables + 1),
      unbounded_(most_functions),
      basis_(most_variables, most_variables),
      inverse_(most_variables, most_variables),
      own_(most_variables, most_variables),
      y_(most_variables),
      edge_(most_variables),
      factors_(most_variables),
      multipliers_(most_variables),
      objective_(most_variables),
      rates_(most_functions) {
  cones_.reserve(most_cones);
  met_.reserve(most_cones);
  start_.reserve(5 * most_cones);
  corner_.reserve(static_cast<std::size_t>(most_variables));
  for (int side = 0; side < kSides; ++side) {
    cosines_.push_back(std::cos(side * kSideAngle));
    sines_.push_back(std::sin(side * kSideAngle));
  }
}

void ConeProgram::start(Eigen::Index variables, Eigen::Index functions) {
  variables_ = variables;
  functions_ = functions;
  cones_.clear();
  table_.topRows(functions).setZero();
}

double ConeProgram::tolerance() const {
  return kZero * scale_;
}

double ConeProgram::combined(const Plane& plane, double normal, double x, double y) const {
  if (plane.side < 0) return normal;
  const auto side = static_cast<std::size_t>(plane.side);
  return cones_[plane.cone].friction * normal - cosines_[side] * x - sines_[side] * y;
}

// The combination of coefficients that must not be negative.
template <typename Row>
void ConeProgram::setPlane(const Plane& plane, Row row) const {
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

void ConeProgram::addStartPlane(const Plane& plane) {
  const auto row = static_cast<Eigen::Index>(start_.size());
  start_.push_back(plane);
  setPlane(plane, start_rows_.row(row).head(variables_).transpose());
}

// Chooses planes that are as independent as can be; their corner is where the search begins.
void ConeProgram::span() {
  start_.clear();
  corner_.clear();
  for (std::size_t c = 0; c < cones_.size(); ++c) {
    addStartPlane({c, -1});
    const int step = cones_[c].count == 2 ? kQuarter : kSides / 2;
    for (int side = 0; cones_[c].count > 0 && side < kSides; side += step) {
      addStartPlane({c, side});
    }
  }
  const auto count = static_cast<Eigen::Index>(start_.size());
  auto rows = start_rows_.topLeftCorner(count, variables_);
  for (rank_ = 0; rank_ < variables_; ++rank_) {
    Eigen::Index largest = 0;
    const double square = count == 0 ? 0 : rows.rowwise().squaredNorm().maxCoeff(&largest);
    if (!(square > kNoCoefficient * kNoCoefficient)) break;
    corner_.push_back(start_[static_cast<std::size_t>(largest)]);
    auto direction = basis_.col(rank_).head(variables_);
    direction = rows.row(largest).transpose();
    for (int twice = 0; twice < 2; ++twice) {
      for (Eigen::Index j = 0; j < rank_; ++j) {
        const auto before = basis_.col(j).head(variables_);
        direction -= before.dot(direction) * before;
      }
      direction.normalize();
    }
    for (Eigen::Index i = 0; i < count; ++i) {
      const double part = rows.row(i).dot(direction);
      rows.row(i) -= part * direction.transpose();
    }
    rows.row(largest).setZero();
  }
}

// Leaves out what no plane bounds of the variables.
void ConeProgram::reduce() {
  for (Eigen::Index i = 0; i < functions_; ++i) {
    auto rest = y_.head(variables_);
    rest = table_.row(i).segment(1, variables_).transpose();
    reduced_(i, 0) = table_(i, 0);
    for (Eigen::Index j = 0; j < rank_; ++j) {
      const auto direction = basis_.col(j).head(variables_);
      const double part = direction.dot(rest);
      reduced_(i, 1 + j) = part;
      rest -= part * direction;
    }
    unbounded_[i] = rank_ < variables_ ? rest.norm() : 0;
  }
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
  double bound = kInfinity;
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
    double bound = kInfinity;
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

// An objective that is at its least in the corner, with multipliers that differ.
void ConeProgram::keepCorner() {
  auto objective = objective_.head(rank_);
  objective.setZero();
  for (Eigen::Index i = 0; i < rank_; ++i) {
    setPlane(corner_[static_cast<std::size_t>(i)], edge_.head(rank_));
    objective += (1 + static_cast<double>(i) / static_cast<double>(rank_)) * edge_.head(rank_);
  }
}

ConeProgram::Found ConeProgram::solve(double scale) {
  scale_ = scale;
  side_step_ = 1;
  rank_ = variables_;
  reduced_.topLeftCorner(functions_, variables_ + 1) =
      table_.topLeftCorner(functions_, variables_ + 1);
  span();
  reduce();
  if (!refresh()) return Found::kUnclear;
  keepCorner();
  const Step step = restore();
  start_ = corner_;
  if (step == Step::kDone) return Found::kFeasible;
  return step == Step::kInfeasible ? Found::kInfeasible : Found::kUnclear;
}

// First on pyramids of few sides, whose least value the others are then added to; where that leads
// nowhere, on all sides from the corner that solve() found. There each search begins: one that
// finds no least value ends far away.
double ConeProgram::least(Eigen::Index function, double sign) {
  if (unbounded_[function] > kNoCoefficient) return -kInfinity;
  for (const int step : {kCoarse, 1}) {
    corner_ = start_;
    if (!refresh()) break;
    objective_.head(rank_) = sign * reduced_.row(function).segment(1, rank_).transpose();
    side_step_ = step;
    Step found = improve();
    side_step_ = 1;
    // An edge that no side meets needs no corner that is exact.
    if (found == Step::kUnbounded && !blocking(false).found) return -kInfinity;
    if (step > 1 && (found != Step::kDone || restore() != Step::kDone)) continue;
    if (step > 1) found = improve();
    if (found == Step::kUnbounded) return -kInfinity;
    const double value = sign * valueOf(function);
    if (found == Step::kDone) return value;
    if (value < -kMostScales * scale_) return -kInfinity;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

std::pair<double, double> ConeProgram::range(Eigen::Index function) {
  const double lower = least(function, 1);
  return {lower, -least(function, -1)};
}

}  // namespace virtual_work_dynamics
