#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "virtual_work_dynamics/block.h"
#include "virtual_work_dynamics/closed_loop_dynamics.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/load.h"
#include "virtual_work_dynamics/results.h"

namespace virtual_work_dynamics {

/// Where the numbers of a result stand when they are written one after the other: efforts, child
/// axes, root axes.
struct ResultNumbers {
  explicit ResultNumbers(const Results& results)
      : efforts(static_cast<std::size_t>(results.effort.size())),
        child_axes(results.child_axes.size()),
        root_axes(results.root_axes.size()) {}

  std::size_t all() const { return efforts + 6 * (child_axes + root_axes); }

  std::size_t efforts, child_axes, root_axes;
};

/// Calls take(index, number) for all numbers of a result.
template <typename Take>
void forEachNumber(const Results& results, const Take& take) {
  std::size_t index = 0;
  for (Eigen::Index i = 0; i < results.effort.size(); ++i) take(index++, results.effort[i]);
  for (const auto* wrenches : {&results.child_axes, &results.root_axes}) {
    for (const Wrench& wrench : *wrenches) {
      for (const Eigen::Vector3d* vector : {&wrench.force, &wrench.torque}) {
        for (int i = 0; i < 3; ++i) take(index++, (*vector)[i]);
      }
    }
  }
}

/// Marks the numbers of a result that have a value which rigid-body mechanics determines; does not
/// allocate when `known` has the length already.
void markKnown(const Results& results, std::vector<bool>& known);

/// Results of a sample and of samples in each of which one number of the motion is shifted. Column
/// 0 is the sample, column 1 + level * coordinates + i shifts that level of coordinate i. Serves
/// one thread.
class ShiftedSamples {
 public:
  virtual ~ShiftedSamples() = default;

  /// Computes all samples. Does not allocate.
  /// @param shifts coordinates x levels; the number of levels was given to the constructor
  /// @param law the load at each sample's position
  virtual void compute(const Motion& motion, const Eigen::MatrixXd& shifts, const LoadLaw& law) = 0;
  /// The samples' values of one number of ResultNumbers.
  virtual const double* values(std::size_t number) const = 0;
  /// Whether a number has a value that is determined; by number, empty where all have.
  virtual const std::vector<bool>& known() const = 0;
};

/// Samples of an open chain: a block, in which all values of a number lie one after the other.
class ShiftedChain : public ShiftedSamples {
 public:
  /// @param dynamics must outlive it
  /// @param own the scene's load
  ShiftedChain(const InverseDynamics& dynamics, const Load& own, int levels);

  void compute(const Motion& motion, const Eigen::MatrixXd& shifts, const LoadLaw& law) override;
  const double* values(std::size_t number) const override {
    return outputs_.data() + number * samples_;
  }
  const std::vector<bool>& known() const override { return known_; }

 private:
  void setOrientations(const Motion& motion);
  void setRoots(const Motion& motion);
  void setLoads(const Motion& motion, const Eigen::MatrixXd& shifts, const LoadLaw& law);

  const InverseDynamics& dynamics_;
  BlockInverseDynamics<double> block_;
  const std::size_t coordinates_;
  std::size_t samples_;  // whole packs of vector instructions
  std::vector<double> inputs_, root_, orientations_, outputs_;
  ResultBlock<double> results_;
  Eigen::VectorXd position_;  // of a sample
  std::vector<Load> loads_;   // of the samples
  std::vector<bool> known_;
};

/// Samples of closed loops: independent coordinates are shifted, and the others follow. The samples
/// of shifts of the others are not computed.
class ShiftedLoops : public ShiftedSamples {
 public:
  /// @param dynamics must outlive it
  /// @param own the scene's load
  ShiftedLoops(const ClosedLoopDynamics& dynamics, const Load& own,
               const std::vector<bool>& independent, int levels);

  void compute(const Motion& motion, const Eigen::MatrixXd& shifts, const LoadLaw& law) override;
  const double* values(std::size_t number) const override {
    return values_.data() + number * samples_;
  }
  const std::vector<bool>& known() const override { return known_; }

 private:
  bool computeSample(std::size_t sample, const LoadLaw& law);

  const ClosedLoopDynamics& dynamics_;
  const std::vector<bool> independent_;
  ClosedLoopDynamics::Workspace workspace_;
  const ResultNumbers numbers_;
  const std::size_t samples_;
  Motion shifted_;
  Load load_;  // of shifted_
  std::vector<double> values_;
  std::vector<bool> known_;
};

/// Chooses coordinates whose motion determines that of all others at the assembly, given ones
/// first. Allocates.
std::vector<bool> independentCoordinates(const ClosedLoopDynamics& dynamics);

}  // namespace virtual_work_dynamics
