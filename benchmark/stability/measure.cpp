#include "stability/measure.h"

#ifdef VWD_HAS_REAL113

#include <algorithm>
#include <cmath>
#include <limits>

#include "stability/kdl_efforts.h"
#include "stability/loop_judge.h"
#include "stability/own_paths.h"
#include "virtual_work_dynamics/instruction_set.h"

namespace virtual_work_dynamics {
namespace {

// Sensitivities take one more evaluation in 113 bits: every so many states have one.
constexpr int kStatesForEachSensitivity = 4;

// Float's numbers are 1e-45 to 3e38: this leaves room for a product with another factor of the
// input.
constexpr long double kLargestOfFloat = 1e30L;

// Whether float has such numbers; those that are small beside others may vanish.
bool fitsFloat(long double size) {
  const bool vanishes = size > 0 && size < std::numeric_limits<float>::denorm_min();
  return size <= kLargestOfFloat && !vanishes;
}

bool fitsFloat(const Eigen::VectorXd& values) {
  return values.size() == 0 || fitsFloat(values.cwiseAbs().maxCoeff());
}

bool fitsFloat(const Mechanism& mechanism) {
  const auto link_fits = [](const Link& link) {
    return fitsFloat(link.mass) && link.p_KoCm_K.norm() <= kLargestOfFloat &&
           link.inertia_Cm_K.norm() <= kLargestOfFloat;
  };
  const auto joint_fits = [](const Joint& joint) {
    return joint.p_PoKo_P.norm() <= kLargestOfFloat;
  };
  return std::all_of(mechanism.links().begin(), mechanism.links().end(), link_fits) &&
         std::all_of(mechanism.joints().begin(), mechanism.joints().end(), joint_fits);
}

bool fitsFloat(const Motion& motion, const ErrorBound& bound) {
  const auto wrench_fits = [](const WrenchMagnitude& wrench) {
    return wrench.force <= kLargestOfFloat && wrench.moment <= kLargestOfFloat;
  };
  return fitsFloat(motion.q) && fitsFloat(motion.qd) && fitsFloat(motion.qdd) &&
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
    for (Eigen::Index i = 0; i < values->size(); ++i) {
      (*values)[i] = neighbour((*values)[i], random.chance(0.5), numbers);
    }
  }
  return moved;
}

Verdict measureLoops(const StabilityCase& stability_case, std::uint32_t seed, int count) {
  LoopJudge judge(stability_case.mechanism, stability_case.scene);
  RandomNumbers random(seed);
  LoopVerdict loops;
  for (int n = 0; n < count; ++n) {
    const Motion motion = stability_case.motion(random);
    loops.include(judge.judge(motion, random));
    if (n % kStatesForEachSensitivity != 0) continue;
    const Motion moved = movedByOneUlp(motion, InputNumbers::kDouble, random);
    loops.sensitivity = std::max(loops.sensitivity, judge.sensitivity(motion, moved));
  }
  Verdict verdict;
  verdict.paths = {{"closed_loops", "double", loops.errors}};
  verdict.sensitivity = loops.sensitivity;
  verdict.loops = loops;
  return verdict;
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
  if (other.loops) {
    if (!loops) loops = LoopVerdict();
    loops->include(*other.loops);
  }
  if (other.kdl) {
    if (!kdl) kdl = Errors();
    kdl->include(*other.kdl);
  }
  if (!other.certificates) return;
  if (!certificates) certificates = WorstCertificates();
  certificates->include(*other.certificates);
}

double Verdict::overSubtreeBound(const std::string& precision) const {
  double largest = 0;
  for (const PathVerdict& path : paths) {
    if (path.precision == precision) largest = std::max(largest, path.errors.over_subtree_bound);
  }
  return largest;
}

Verdict measureStates(const StabilityCase& stability_case, InputNumbers numbers, std::uint32_t seed,
                      int count) {
  const bool is_float = numbers == InputNumbers::kFloat;
  if (needsClosedLoops(stability_case.scene)) {
    return is_float ? Verdict() : measureLoops(stability_case, seed, count);
  }
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
  const std::string certified = singlePathName(chosenInstructionSet());
  for (const Path& path : is_float ? floatPaths(mechanism, scene) : doublePaths(mechanism, scene)) {
    const std::vector<StateResults> results = path.compute(motions);
    PathVerdict judged{path.name, path.precision, {}};
    for (std::size_t n = 0; n < exact.size(); ++n) {
      bound.compute(motions[n], path.limits.least);
      judged.errors.include(exact[n].errorsOf(results[n], path.limits, bound));
    }
    verdict.paths.push_back(std::move(judged));
    if (path.name == certified) {
      verdict.certificates = certify(mechanism, scene, motions, results);
    }
  }
  if (!is_float && kdlComputes(mechanism, scene)) {
    const std::vector<std::vector<double>> efforts = kdlEfforts(mechanism, scene, motions);
    const PrecisionLimits limits = limitsOf<double>();
    verdict.kdl = Errors();
    for (std::size_t n = 0; n < exact.size(); ++n) {
      bound.compute(motions[n], limits.least);
      verdict.kdl->include(exact[n].errorsOfEfforts(efforts[n], limits, bound));
    }
  }
  return verdict;
}

}  // namespace virtual_work_dynamics

#endif  // VWD_HAS_REAL113
