#include "stability/measure.h"

#ifdef VWD_HAS_REAL113

#include <algorithm>
#include <cmath>
#include <limits>

#include "stability/kdl_efforts.h"
#include "stability/own_paths.h"

namespace virtual_work_dynamics {
namespace {

// Sensitivities take one more evaluation in 113 bits: every so many states have one.
constexpr int kStatesForEachSensitivity = 4;

// Float's range is 1e-45 to 3e38: this leaves room for products of two factors of the input.
constexpr double kSmallestOfFloat = 1e-30, kLargestOfFloat = 1e30;

bool fitsFloat(long double value) {
  const long double size = std::fabs(value);
  return size == 0 || (size >= kSmallestOfFloat && size <= kLargestOfFloat);
}

bool fitsFloat(const Mechanism& mechanism) {
  const auto link_fits = [](const Link& link) {
    const long double arm = link.p_KoCm_K.norm();
    return fitsFloat(link.mass) && fitsFloat(arm) && fitsFloat(link.mass * arm) &&
           fitsFloat(link.mass * arm * arm) && fitsFloat(link.inertia_Cm_K.norm());
  };
  const auto joint_fits = [](const Joint& joint) { return fitsFloat(joint.p_PoKo_P.norm()); };
  return std::all_of(mechanism.links().begin(), mechanism.links().end(), link_fits) &&
         std::all_of(mechanism.joints().begin(), mechanism.joints().end(), joint_fits);
}

bool fitsFloat(const Motion& motion, const ErrorBound& bound) {
  const auto numbers_fit = [](const Eigen::VectorXd& values) {
    return std::all_of(values.data(), values.data() + values.size(),
                       [](double value) { return fitsFloat(value); });
  };
  const auto wrench_fits = [](const WrenchMagnitude& wrench) {
    return fitsFloat(wrench.force) && fitsFloat(wrench.moment);
  };
  return numbers_fit(motion.q) && numbers_fit(motion.qd) && numbers_fit(motion.qdd) &&
         std::all_of(bound.wrenches().begin(), bound.wrenches().end(), wrench_fits);
}

double neighbour(double value, bool up, InputNumbers numbers) {
  if (numbers == InputNumbers::kFloat) {
    const float infinity = std::numeric_limits<float>::infinity();
    return std::nextafter(static_cast<float>(value), up ? infinity : -infinity);
  }
  const double infinity = std::numeric_limits<double>::infinity();
  return std::nextafter(value, up ? infinity : -infinity);
}

Motion movedByOneUlp(const Motion& motion, InputNumbers numbers, RandomNumbers& random) {
  Motion moved = motion;
  for (Eigen::VectorXd* values : {&moved.q, &moved.qd, &moved.qdd}) {
    for (double& value : *values) value = neighbour(value, random.chance(0.5), numbers);
  }
  return moved;
}

}  // namespace

void Verdict::include(const Verdict& other) {
  for (const PathVerdict& path : other.paths) {
    const auto same = [&](const PathVerdict& mine) {
      return mine.path == path.path && mine.precision == path.precision;
    };
    const auto found = std::find_if(paths.begin(), paths.end(), same);
    if (found == paths.end()) {
      paths.push_back(path);
    } else {
      found->errors.include(path.errors);
    }
  }
  sensitivity = std::max(sensitivity, other.sensitivity);
  if (other.kdl) kdl = std::max(kdl.value_or(0), *other.kdl);
}

Verdict measureStates(const StabilityCase& stability_case, InputNumbers numbers, std::uint32_t seed,
                      int count) {
  const bool is_float = numbers == InputNumbers::kFloat;
  Verdict verdict;
  if (is_float && !fitsFloat(stability_case.mechanism)) return verdict;
  const Mechanism mechanism =
      is_float ? withFloatGears(stability_case.mechanism) : stability_case.mechanism;
  const Scene& scene = stability_case.scene;
  RandomNumbers random(seed);
  ErrorBound bound(mechanism, scene);
  std::vector<Motion> motions;
  std::vector<ExactResults> exact;
  for (int n = 0; n < count; ++n) {
    Motion motion = stability_case.motion(random);
    bound.compute(motion);
    if (is_float) {
      if (!fitsFloat(motion, bound)) return Verdict();
      motion = roundedToFloat(motion);
      bound.compute(motion);
    }
    exact.emplace_back(mechanism, scene, motion, bound);
    if (n % kStatesForEachSensitivity == 0) {
      const ExactResults moved(mechanism, scene, movedByOneUlp(motion, numbers, random), bound);
      verdict.sensitivity = std::max(verdict.sensitivity, exact.back().relativeDifference(moved));
    }
    motions.push_back(std::move(motion));
  }
  for (const Path& path : is_float ? floatPaths(mechanism, scene) : doublePaths(mechanism, scene)) {
    const std::vector<StateResults> results = path.compute(motions);
    PathVerdict judged{path.name, path.precision, {}};
    for (std::size_t n = 0; n < exact.size(); ++n) {
      judged.errors.include(exact[n].errorsOf(results[n], path.limits));
    }
    verdict.paths.push_back(std::move(judged));
  }
  if (!is_float && kdlComputes(mechanism, scene)) {
    const std::vector<std::vector<double>> efforts = kdlEfforts(mechanism, scene, motions);
    verdict.kdl = 0;
    for (std::size_t n = 0; n < exact.size(); ++n) {
      verdict.kdl = std::max(*verdict.kdl, exact[n].relativeErrorOfEfforts(efforts[n]));
    }
  }
  return verdict;
}

}  // namespace virtual_work_dynamics

#endif  // VWD_HAS_REAL113
