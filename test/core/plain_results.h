#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "fenced_array.h"
#include "virtual_work_dynamics/block.h"

namespace virtual_work_dynamics {

/// Results of one sample as plain numbers, in the order of a ResultBlock.
template <typename Real>
struct PlainResults {
  std::vector<Real> effort, child_axes, root_axes, poses, twists;
};

/// The instruction sets that this machine runs.
inline std::vector<InstructionSet> supportedInstructionSets() {
  std::vector<InstructionSet> supported;
  for (const InstructionSet set :
       {InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512}) {
    if (isSupported(set)) supported.push_back(set);
  }
  return supported;
}

/// A request for efforts, reactions of all movable joints in both axes, poses and twists.
inline Request requestAll(const Mechanism& mechanism) {
  Request request;
  request.child_axes = request.root_axes = requestedReactions(mechanism, Scene());
  request.poses = request.twists = true;
  return request;
}

/// A request for efforts, reactions of all joints and ground in both axes, poses and twists.
inline Request requestEveryJoint(const Mechanism& mechanism) {
  Request request;
  request.child_axes.push_back(kGround);
  for (const Joint& joint : mechanism.joints()) request.child_axes.push_back(joint.name);
  request.root_axes = request.child_axes;
  request.poses = request.twists = true;
  return request;
}

/// The results of one sample, without poses, which a Workspace gives as quaternions.
inline PlainResults<double> singleResults(const Workspace& workspace) {
  PlainResults<double> results;
  const auto append = [](std::vector<double>& to, const Eigen::Vector3d& v) {
    to.insert(to.end(), v.data(), v.data() + 3);
  };
  results.effort.assign(workspace.effort().data(),
                        workspace.effort().data() + workspace.effort().size());
  for (const Wrench& wrench : workspace.childAxes()) {
    append(results.child_axes, wrench.force);
    append(results.child_axes, wrench.torque);
  }
  for (const Wrench& wrench : workspace.rootAxes()) {
    append(results.root_axes, wrench.force);
    append(results.root_axes, wrench.torque);
  }
  for (const Twist& twist : workspace.twists()) {
    append(results.twists, twist.linear);
    append(results.twists, twist.angular);
  }
  return results;
}

inline PlainResults<double> singleResults(const InverseDynamics& dynamics, const Motion& motion) {
  Workspace workspace = dynamics.makeWorkspace();
  dynamics.compute(motion, workspace);
  return singleResults(workspace);
}

/// The arrays of a block, each between fences; they are filled from motions and divided into
/// samples.
template <typename Real>
class FencedBlock {
 public:
  using Array = FencedArray<Real>;

  FencedBlock(const BlockInverseDynamics<Real>& dynamics, const std::vector<Motion>& motions,
              BlockLayout layout, typename Array::Edge edge = Array::kFenceBehind)
      : layout_(layout), samples_(motions.size()) {
    const std::size_t coordinates = dynamics.coordinates();
    const Request& request = dynamics.request();
    const std::size_t in_root_axes = request.root_axes.size();
    const std::size_t numbers[] = {coordinates,
                                   coordinates,
                                   coordinates,
                                   request.efforts ? coordinates : 0,
                                   6 * request.child_axes.size(),
                                   6 * in_root_axes,
                                   request.poses ? 12 * in_root_axes : 0,
                                   request.twists ? 6 * in_root_axes : 0};
    std::copy(std::begin(numbers), std::end(numbers), columns_);
    for (int i = 0; i < kArrays; ++i) {
      arrays_[i].reset(new Array(columns_[i] * samples_, edge));
    }
    for (std::size_t n = 0; n < samples_; ++n) {
      for (std::size_t c = 0; c < coordinates; ++c) {
        const Eigen::Index index = static_cast<Eigen::Index>(c);
        at(0, n, c) = static_cast<Real>(motions[n].q[index]);
        at(1, n, c) = static_cast<Real>(motions[n].qd[index]);
        at(2, n, c) = static_cast<Real>(motions[n].qdd[index]);
      }
    }
  }

  void compute(BlockInverseDynamics<Real>& dynamics) { dynamics.compute(layout_, in(), out()); }
  /// With a load, or with the first of the loads of all samples.
  template <typename Loads>
  void compute(BlockInverseDynamics<Real>& dynamics, const Loads& loads) {
    dynamics.compute(layout_, in(), loads, out());
  }

  MotionBlock<Real> in() { return {samples_, array(0), array(1), array(2)}; }
  /// The result arrays; those that were not requested are null.
  ResultBlock<Real> out() { return {array(3), array(4), array(5), array(6), array(7)}; }

  PlainResults<Real> sample(std::size_t n) const {
    return {numbers(3, n), numbers(4, n), numbers(5, n), numbers(6, n), numbers(7, n)};
  }
  std::vector<PlainResults<Real>> samples() const {
    std::vector<PlainResults<Real>> samples;
    for (std::size_t n = 0; n < samples_; ++n) samples.push_back(sample(n));
    return samples;
  }

  bool surroundingsUntouched() const {
    return std::all_of(std::begin(arrays_), std::end(arrays_),
                       [](const auto& array) { return array->surroundingsUntouched(); });
  }

 private:
  static constexpr int kArrays = 8;  // three inputs, five outputs

  Real* array(int i) const { return columns_[i] > 0 ? arrays_[i]->data() : nullptr; }
  Real& at(int i, std::size_t sample, std::size_t column) const {
    return arrays_[i]->data()[layout_ == BlockLayout::kRowMajor ? sample * columns_[i] + column
                                                                : column * samples_ + sample];
  }
  std::vector<Real> numbers(int i, std::size_t sample) const {
    std::vector<Real> numbers;
    for (std::size_t c = 0; c < columns_[i]; ++c) numbers.push_back(at(i, sample, c));
    return numbers;
  }

  BlockLayout layout_;
  std::size_t samples_;
  std::size_t columns_[kArrays];
  std::unique_ptr<Array> arrays_[kArrays];
};

/// Computes all samples in one block.
template <typename Real>
std::vector<PlainResults<Real>> blockResults(
    BlockInverseDynamics<Real>& dynamics, const std::vector<Motion>& motions, BlockLayout layout,
    typename FencedArray<Real>::Edge edge = FencedArray<Real>::kFenceBehind) {
  FencedBlock<Real> block(dynamics, motions, layout, edge);
  block.compute(dynamics);
  EXPECT_TRUE(block.surroundingsUntouched());
  return block.samples();
}

/// All samples through one block, with a load.
template <typename Real>
std::vector<PlainResults<Real>> blockResults(BlockInverseDynamics<Real>& dynamics,
                                             const std::vector<Motion>& motions, BlockLayout layout,
                                             const Load& load) {
  FencedBlock<Real> block(dynamics, motions, layout);
  block.compute(dynamics, load);
  EXPECT_TRUE(block.surroundingsUntouched());
  return block.samples();
}

/// All samples through one block, each with its load.
template <typename Real>
std::vector<PlainResults<Real>> blockResults(BlockInverseDynamics<Real>& dynamics,
                                             const std::vector<Motion>& motions, BlockLayout layout,
                                             const Load* loads) {
  FencedBlock<Real> block(dynamics, motions, layout);
  block.compute(dynamics, loads);
  EXPECT_TRUE(block.surroundingsUntouched());
  return block.samples();
}

template <typename Real>
std::vector<PlainResults<Real>> blockResults(const InverseDynamics& dynamics,
                                             const std::vector<Motion>& motions, BlockLayout layout,
                                             int threads, InstructionSet instruction_set) {
  BlockInverseDynamics<Real> block(dynamics, threads, instruction_set);
  return blockResults(block, motions, layout);
}

template <typename Real>
bool sameBits(const std::vector<Real>& a, const std::vector<Real>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Real)) == 0);
}

/// Names of the results that differ; empty when all are equal.
template <typename Real>
std::string differences(const PlainResults<Real>& a, const PlainResults<Real>& b) {
  std::string names;
  if (!sameBits(a.effort, b.effort)) names += " effort";
  if (!sameBits(a.child_axes, b.child_axes)) names += " child_axes";
  if (!sameBits(a.root_axes, b.root_axes)) names += " root_axes";
  if (!sameBits(a.poses, b.poses)) names += " poses";
  if (!sameBits(a.twists, b.twists)) names += " twists";
  return names;
}

}  // namespace virtual_work_dynamics
