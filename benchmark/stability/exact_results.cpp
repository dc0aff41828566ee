#include "stability/exact_results.h"

#ifdef VWD_HAS_REAL113

#include <algorithm>
#include <cmath>
#include <limits>

namespace virtual_work_dynamics {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// What is smaller, relative to the terms it is the sum of, is zero except for the rounding of 113
// bits.
constexpr long double kZero113 = 0x1p-100L;

// L of the bound, and of the narrower one.
struct Depths {
  int path, subtree;
};

// The norm of the difference between three numbers and the exact ones.
long double distance(const long double* numbers, const ExactNumber* exact, int count) {
  long double sum = 0;
  for (int i = 0; i < count; ++i) {
    const long double difference = (numbers[i] - exact[i].high) - exact[i].low;
    sum += difference * difference;
  }
  return std::sqrt(sum);
}

long double normOf(const ExactNumber* v) {
  return std::sqrt(v[0].high * v[0].high + v[1].high * v[1].high + v[2].high * v[2].high);
}

bool withinRange(const ExactNumber* exact, int count, long double largest) {
  return std::all_of(exact, exact + count, [&](const ExactNumber& number) {
    return std::fabs(number.high) <= largest;  // false for NaN
  });
}

// Not finite: infinite, and never lost in a maximum as NaN would be.
double ratio(long double error, long double unit) {
  if (error == 0) return 0;
  const double value = static_cast<double>(error / unit);
  return std::isfinite(error) && !std::isnan(value) ? value : kInfinity;
}

void takeRelative(long double error, long double largest, double& relative) {
  if (largest > 0) relative = std::max(relative, ratio(error, largest));
}

std::string nameOf(const Mechanism& mechanism, std::size_t link) {
  return link == 0 ? kGround : mechanism.joints()[link - 1].name;
}

template <typename Name>
void take(long double error, long double magnitude, const Depths& depths,
          const PrecisionLimits& limits, Errors& errors, const Name& name) {
  const long double unit = 4 * limits.eps * magnitude;
  const double over_subtree_bound = ratio(error, depths.subtree * unit);
  errors.over_subtree_bound = std::max(errors.over_subtree_bound, over_subtree_bound);
  const double over_bound = ratio(error, depths.path * unit);
  if (over_bound <= errors.over_bound) return;
  errors.over_bound = over_bound;
  errors.worst = name();
}

}  // namespace

void Errors::include(const Errors& other) {
  if (other.over_bound > over_bound) {
    over_bound = other.over_bound;
    worst = other.worst;
  }
  over_subtree_bound = std::max(over_subtree_bound, other.over_subtree_bound);
  relative = std::max(relative, other.relative);
}

ExactResults::ExactResults(const Mechanism& mechanism, const Scene& scene, const Motion& motion,
                           const ErrorBound& bound)
    : mechanism_(mechanism) {
  const Reference113 reference(mechanism, scene, motion);
  for (const Real113 effort : reference.efforts()) efforts_.emplace_back(effort);
  for (int k = -1; k < static_cast<int>(mechanism.joints().size()); ++k) {
    child_axes_.push_back(split(reference.childAxes(k)));
    root_axes_.push_back(split(reference.rootAxes(k)));
  }
  noteLargest(bound);
  countSubtrees(bound);
}

ExactResults::Wrench ExactResults::split(const Reference113::Wrench& wrench) {
  const Vector113 &f = wrench.force, &m = wrench.torque;
  return {{ExactNumber(f.x), ExactNumber(f.y), ExactNumber(f.z)},
          {ExactNumber(m.x), ExactNumber(m.y), ExactNumber(m.z)}};
}

void ExactResults::countSubtrees(const ErrorBound& bound) {
  subtree_depths_ = bound.depths();
  effort_subtree_depths_.assign(efforts_.size(), 0);
  std::vector<int> before(subtree_depths_.size(), 0);  // joints, of each link's joint
  for (std::size_t i = 1; i < before.size(); ++i) {
    const Joint& joint = mechanism_.joints()[i - 1];
    before[i] = joint.parent_link == 0 ? 0 : before[joint.parent_link] + 1;
    subtree_depths_[i] -= before[i];
    if (joint.coordinate < 0) continue;
    int& depth = effort_subtree_depths_[joint.coordinate];
    depth = std::max(depth, subtree_depths_[i]);
  }
}

void ExactResults::noteLargest(const ErrorBound& bound) {
  long double force_terms = 0, moment_terms = 0;
  for (std::size_t i = 0; i < child_axes_.size(); ++i) {
    largest_force_ = std::max(largest_force_, normOf(child_axes_[i].force));
    largest_moment_ = std::max(largest_moment_, normOf(child_axes_[i].moment));
    force_terms = std::max<long double>(force_terms, bound.wrenches()[i].force);
    moment_terms = std::max<long double>(moment_terms, bound.wrenches()[i].moment);
  }
  for (std::size_t i = 0; i < efforts_.size(); ++i) {
    long double& largest = turns(i) ? largest_moment_ : largest_force_;
    largest = std::max(largest, std::fabs(efforts_[i].high));
    long double& terms = turns(i) ? moment_terms : force_terms;
    terms = std::max<long double>(terms, bound.efforts()[i]);
  }
  if (largest_force_ < kZero113 * force_terms) largest_force_ = 0;
  if (largest_moment_ < kZero113 * moment_terms) largest_moment_ = 0;
}

bool ExactResults::turns(std::size_t coordinate) const {
  const int joint = mechanism_.coordinates()[coordinate];
  return mechanism_.joints()[joint].type != JointType::kPrismatic;
}

void ExactResults::judgeEfforts(const std::vector<long double>& results,
                                const PrecisionLimits& limits, const ErrorBound& bound,
                                Errors& errors) const {
  for (std::size_t i = 0; i < efforts_.size(); ++i) {
    if (!withinRange(&efforts_[i], 1, limits.largest)) continue;
    const long double error = distance(&results[i], &efforts_[i], 1);
    take(error, bound.efforts()[i], {bound.effortDepths()[i], effort_subtree_depths_[i]}, limits,
         errors, [&] { return "effort of " + mechanism_.coordinateNames()[i]; });
    takeRelative(error, turns(i) ? largest_moment_ : largest_force_, errors.relative);
  }
}

void ExactResults::judgeWrenches(const std::vector<Wrench>& exact,
                                 const std::vector<long double>& results,
                                 const PrecisionLimits& limits, const ErrorBound& bound,
                                 const char* axes, Errors& errors) const {
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const Wrench& wrench = exact[i];
    const WrenchMagnitude& magnitude = bound.wrenches()[i];
    const Depths depths{bound.depths()[i], subtree_depths_[i]};
    const auto name = [&](const char* what) { return what + (axes + nameOf(mechanism_, i)); };
    if (withinRange(wrench.force, 3, limits.largest)) {
      const long double error = distance(&results[6 * i], wrench.force, 3);
      take(error, magnitude.force, depths, limits, errors, [&] { return name("force"); });
      takeRelative(error, largest_force_, errors.relative);
    }
    if (withinRange(wrench.moment, 3, limits.largest)) {
      const long double error = distance(&results[6 * i + 3], wrench.moment, 3);
      take(error, magnitude.moment, depths, limits, errors, [&] { return name("moment"); });
      takeRelative(error, largest_moment_, errors.relative);
    }
  }
}

Errors ExactResults::errorsOf(const StateResults& results, const PrecisionLimits& limits,
                              const ErrorBound& bound) const {
  Errors errors;
  judgeEfforts(results.efforts, limits, bound, errors);
  judgeWrenches(child_axes_, results.child_axes, limits, bound, " in child axes of ", errors);
  judgeWrenches(root_axes_, results.root_axes, limits, bound, " in root axes of ", errors);
  return errors;
}

Errors ExactResults::errorsOfEfforts(const std::vector<double>& efforts,
                                     const PrecisionLimits& limits, const ErrorBound& bound) const {
  Errors errors;
  judgeEfforts({efforts.begin(), efforts.end()}, limits, bound, errors);
  return errors;
}

double ExactResults::relativeDifference(const ExactResults& other) const {
  double relative = 0;
  const auto differ = [&](const ExactNumber* a, const ExactNumber* b, int count,
                          long double largest) {
    long double sum = 0;
    for (int i = 0; i < count; ++i) {
      const long double difference = (b[i].high - a[i].high) + (b[i].low - a[i].low);
      sum += difference * difference;
    }
    takeRelative(std::sqrt(sum), largest, relative);
  };
  for (std::size_t i = 0; i < efforts_.size(); ++i) {
    differ(&efforts_[i], &other.efforts_[i], 1, turns(i) ? largest_moment_ : largest_force_);
  }
  for (std::size_t i = 0; i < child_axes_.size(); ++i) {
    differ(child_axes_[i].force, other.child_axes_[i].force, 3, largest_force_);
    differ(child_axes_[i].moment, other.child_axes_[i].moment, 3, largest_moment_);
    differ(root_axes_[i].force, other.root_axes_[i].force, 3, largest_force_);
    differ(root_axes_[i].moment, other.root_axes_[i].moment, 3, largest_moment_);
  }
  return relative;
}

}  // namespace virtual_work_dynamics

#endif  // VWD_HAS_REAL113
