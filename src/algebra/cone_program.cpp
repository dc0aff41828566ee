#include "algebra/cone_program.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace virtual_work_dynamics {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// A decrease that is bounded by one is zero or one; what is larger than this is one.
constexpr double kReceding = 0.5;
constexpr int kQuarter = ConeProgram::kSides / 4;
// Corners of pyramids with fewer sides lead close to a least value, with fewer steps.
constexpr int kCoarse = ConeProgram::kSides / 16;

}  // namespace

ConeProgram::ConeProgram(Eigen::Index most_variables, Eigen::Index most_functions,
                         std::size_t most_cones)
    : most_variables_(most_variables),
      start_rows_(5 * static_cast<Eigen::Index>(most_cones), most_variables + 1),
      table_(most_functions, most_variables + 1),
      reduced_(most_functions + 1, most_variables + 1),
      unbounded_(most_functions),
      basis_(most_variables, most_variables),
      inverse_(most_variables, most_variables),
      own_(most_variables, most_variables),
      y_(most_variables),
      edge_(most_variables),
      factors_(most_variables),
      multipliers_(most_variables),
      objective_(most_variables),
      rates_(most_functions + 1) {
  cones_.reserve(most_cones + 1);
  met_.reserve(most_cones + 1);
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
  return recedes(function, sign) ? -kInfinity : std::numeric_limits<double>::quiet_NaN();
}

// Whether a function decreases along a direction in which no plane is ever met: these directions
// are the cones for values that are zero at y = 0. One more plane bounds the decrease by one, so
// that the least value of this program is zero or minus one.
bool ConeProgram::recedes(Eigen::Index function, double sign) {
  const double scale = scale_;
  reduced_.col(0).head(functions_).setZero();
  reduced_.row(functions_) = sign * reduced_.row(function);
  reduced_(functions_, 0) = 1;
  cones_.push_back({functions_, 0, 0, 0});
  ++functions_;
  scale_ = 1;
  corner_ = start_;
  bool found = false;
  if (refresh()) {
    objective_.head(rank_) = sign * reduced_.row(function).segment(1, rank_).transpose();
    found = improve() == Step::kDone && sign * valueOf(function) < -kReceding;
  }
  --functions_;
  cones_.pop_back();
  scale_ = scale;
  reduced_.col(0).head(functions_) = table_.col(0).head(functions_);
  return found;
}

std::pair<double, double> ConeProgram::range(Eigen::Index function) {
  const double lower = least(function, 1);
  return {lower, -least(function, -1)};
}

}  // namespace virtual_work_dynamics
