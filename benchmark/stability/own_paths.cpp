#include "stability/own_paths.h"

#ifdef VWD_HAS_REAL113

#include <limits>
#include <memory>

#include "contenders/long_double_dynamics.h"
#include "virtual_work_dynamics/block.h"

namespace virtual_work_dynamics {
namespace {

constexpr InstructionSet kInstructionSets[] = {InstructionSet::kBaseline, InstructionSet::kAvx2,
                                               InstructionSet::kAvx512};

void append(std::vector<long double>& to, const Eigen::Vector3d& v) {
  to.insert(to.end(), v.data(), v.data() + 3);
}

StateResults resultsOf(const Workspace& workspace) {
  StateResults results;
  const Eigen::VectorXd& effort = workspace.effort();
  results.efforts.assign(effort.data(), effort.data() + effort.size());
  for (const Wrench& wrench : workspace.childAxes()) {
    append(results.child_axes, wrench.force);
    append(results.child_axes, wrench.torque);
  }
  for (const Wrench& wrench : workspace.rootAxes()) {
    append(results.root_axes, wrench.force);
    append(results.root_axes, wrench.torque);
  }
  return results;
}

// Numbers of one sample after the other, or one number of all samples after the other.
template <typename Real>
struct Array {
  BlockLayout layout;
  std::size_t samples, width;
  std::vector<Real> numbers = std::vector<Real>(samples * width);

  Real& at(std::size_t sample, std::size_t number) {
    return numbers[layout == BlockLayout::kRowMajor ? sample * width + number
                                                    : number * samples + sample];
  }
  std::vector<long double> row(std::size_t sample) {
    std::vector<long double> row(width);
    for (std::size_t i = 0; i < width; ++i) row[i] = at(sample, i);
    return row;
  }
  void setRow(std::size_t sample, const Eigen::VectorXd& values) {
    for (std::size_t i = 0; i < width; ++i) {
      at(sample, i) = static_cast<Real>(values[static_cast<Eigen::Index>(i)]);
    }
  }
};

template <typename Real>
std::vector<StateResults> computeBlock(BlockInverseDynamics<Real>& dynamics, BlockLayout layout,
                                       const std::vector<Motion>& motions) {
  const std::size_t samples = motions.size(), coordinates = dynamics.coordinates();
  const std::size_t reactions = 6 * dynamics.request().child_axes.size();
  Array<Real> q{layout, samples, coordinates}, qd = q, qdd = q, effort = q;
  Array<Real> child_axes{layout, samples, reactions}, root_axes = child_axes;
  for (std::size_t n = 0; n < samples; ++n) {
    q.setRow(n, motions[n].q);
    qd.setRow(n, motions[n].qd);
    qdd.setRow(n, motions[n].qdd);
  }
  ResultBlock<Real> results;
  results.effort = effort.numbers.data();
  results.child_axes = child_axes.numbers.data();
  results.root_axes = root_axes.numbers.data();
  dynamics.compute(layout, {samples, q.numbers.data(), qd.numbers.data(), qdd.numbers.data()},
                   results);
  std::vector<StateResults> all(samples);
  for (std::size_t n = 0; n < samples; ++n) {
    all[n] = {effort.row(n), child_axes.row(n), root_axes.row(n)};
  }
  return all;
}

template <typename Real>
void addBlocks(const InverseDynamics& dynamics, const char* precision, std::vector<Path>& paths) {
  for (const BlockLayout layout : {BlockLayout::kStructureOfArrays, BlockLayout::kRowMajor}) {
    const std::string name = layout == BlockLayout::kRowMajor ? "block_rows_" : "block_soa_";
    for (const InstructionSet set : kInstructionSets) {
      if (!isSupported(set)) continue;
      const auto block = std::make_shared<BlockInverseDynamics<Real>>(dynamics, 1, set);
      paths.push_back({name + toString(set), precision, limitsOf<Real>(),
                       [block, layout](const std::vector<Motion>& motions) {
                         return computeBlock(*block, layout, motions);
                       }});
    }
  }
}

std::vector<long double> toLongDouble(const Eigen::VectorXd& values) {
  return {values.data(), values.data() + values.size()};
}

Path longDoublePath(const Mechanism& mechanism, const Scene& scene) {
  const auto dynamics =
      std::make_shared<LongDoubleDynamics>(mechanism, scene, everything(mechanism));
  const auto compute = [dynamics](const std::vector<Motion>& motions) {
    std::vector<StateResults> all;
    for (const Motion& motion : motions) {
      const std::vector<long double> q = toLongDouble(motion.q), qd = toLongDouble(motion.qd),
                                     qdd = toLongDouble(motion.qdd);
      dynamics->compute(q.data(), qd.data(), qdd.data());
      all.push_back({dynamics->efforts(), dynamics->childAxes(), dynamics->rootAxes()});
    }
    return all;
  };
  return {"single", "long_double", limitsOf<long double>(), compute};
}

// GCC 12 vectorizes the way of two neighbours to float and back into nothing, at -O2.
double nearestFloat(double value) {
  volatile float nearest = static_cast<float>(value);
  return nearest;
}

}  // namespace

template <typename Real>
PrecisionLimits limitsOf() {
  using Limits = std::numeric_limits<Real>;
  return {Limits::epsilon(), static_cast<double>(Limits::min()), Limits::max()};
}
template PrecisionLimits limitsOf<float>();
template PrecisionLimits limitsOf<double>();
template PrecisionLimits limitsOf<long double>();

std::string singlePathName(InstructionSet instruction_set) {
  return "single_" + toString(instruction_set);
}

Request everything(const Mechanism& mechanism) {
  Request request;
  request.child_axes.push_back(kGround);
  for (const Joint& joint : mechanism.joints()) request.child_axes.push_back(joint.name);
  request.root_axes = request.child_axes;
  return request;
}

Path singlePath(const Mechanism& mechanism, const Scene& scene, InstructionSet instruction_set) {
  const auto dynamics =
      std::make_shared<InverseDynamics>(mechanism, scene, everything(mechanism), instruction_set);
  const auto workspace = std::make_shared<Workspace>(dynamics->makeWorkspace());
  const auto compute = [dynamics, workspace](const std::vector<Motion>& motions) {
    std::vector<StateResults> all;
    for (const Motion& motion : motions) {
      dynamics->compute(motion, *workspace);
      all.push_back(resultsOf(*workspace));
    }
    return all;
  };
  return {singlePathName(instruction_set), "double", limitsOf<double>(), compute};
}

std::vector<Path> doublePaths(const Mechanism& mechanism, const Scene& scene) {
  std::vector<Path> paths;
  for (const InstructionSet set : kInstructionSets) {
    if (isSupported(set)) paths.push_back(singlePath(mechanism, scene, set));
  }
  addBlocks<double>(InverseDynamics(mechanism, scene, everything(mechanism)), "double", paths);
  paths.push_back(longDoublePath(mechanism, scene));
  return paths;
}

std::vector<Path> floatPaths(const Mechanism& mechanism, const Scene& scene) {
  std::vector<Path> paths;
  addBlocks<float>(InverseDynamics(mechanism, scene, everything(mechanism)), "float", paths);
  return paths;
}

Mechanism withFloatGears(const Mechanism& mechanism) {
  std::vector<Joint> joints = mechanism.joints();
  for (Joint& joint : joints) {
    joint.multiplier = nearestFloat(joint.multiplier);
    joint.offset = nearestFloat(joint.offset);
  }
  return Mechanism(mechanism.name(), mechanism.links(), joints);
}

Motion roundedToFloat(const Motion& motion) {
  Motion rounded = motion;
  for (Eigen::VectorXd* values : {&rounded.q, &rounded.qd, &rounded.qdd}) {
    for (Eigen::Index i = 0; i < values->size(); ++i) {
      (*values)[i] = nearestFloat((*values)[i]);
    }
  }
  return rounded;
}

}  // namespace virtual_work_dynamics

#endif  // VWD_HAS_REAL113
