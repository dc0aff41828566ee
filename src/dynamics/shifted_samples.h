#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "dynamics/independent_coordinates.h"
#include "dynamics/root_by_link.h"
#include "virtual_work_dynamics/block.h"
#include "virtual_work_dynamics/closed_loop_dynamics.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/load.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
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

/// Which numbers of a sample are shifted, each in a sample of its own, and where these stand:
/// column 0 is the sample as it is, then come all coordinates' positions, all velocities, all
/// accelerations, the twelve numbers of RootCovariance where the root moves, and the six of each
/// wrench that has a deviation.
struct ShiftPlan {
  ShiftPlan(const Mechanism& mechanism, const Scene& scene);

  std::size_t columnOf(std::size_t level, std::size_t coordinate) const {
    return 1 + level * coordinates + coordinate;
  }
  std::size_t firstOfRoot() const { return 1 + levels * coordinates; }
  std::size_t firstOfWrench(std::size_t i) const { return firstOfRoot() + root + 6 * i; }
  std::size_t columns() const { return firstOfWrench(wrenches.size()); }

  std::size_t coordinates, levels;
  std::size_t root;                   ///< numbers of the root's motion: 12, or 0 where it rests
  std::vector<std::size_t> wrenches;  ///< applied wrenches with deviations
};

/// By how much each of them is shifted.
struct SampleShifts {
  Eigen::MatrixXd coordinates;  ///< coordinates x levels
  /// Whether those of the angles of joints that turn freely shift, instead of these, the numbers of
  /// TurnCovariance. The sample then has orientations, and angles of zero.
  bool turns = false;
  Eigen::Matrix<double, 12, 1> root;  ///< as RootCovariance
  /// The link whose motion `root` shifts, and from which, as MotionCovariance::root_link, the
  /// root's motion follows in each sample.
  int root_link = 0;
  Eigen::VectorXd wrenches;  ///< N and N m; six for each of ShiftPlan::wrenches
};

/// Results of a sample and of the samples of a ShiftPlan. Serves one thread.
class ShiftedSamples {
 public:
  virtual ~ShiftedSamples() = default;

  /// Computes all samples. Does not allocate.
  /// @param law the load at each sample's position
  virtual void compute(const Motion& motion, const SampleShifts& shifts, const LoadLaw& law) = 0;
  /// The samples' values of one number of ResultNumbers.
  virtual const double* values(std::size_t number) const = 0;
  /// Whether a number has a value that is determined; by number, empty where all have.
  virtual const std::vector<bool>& known() const = 0;
};

/// Samples of an open chain: a block, in which all values of a number lie one after the other.
class ShiftedChain : public ShiftedSamples {
 public:
  /// @param dynamics must outlive it, like mechanism and plan
  /// @param own the scene's load
  ShiftedChain(const Mechanism& mechanism, const InverseDynamics& dynamics, const ShiftPlan& plan,
               const Load& own);

  void compute(const Motion& motion, const SampleShifts& shifts, const LoadLaw& law) override;
  const double* values(std::size_t number) const override {
    return outputs_.data() + number * samples_;
  }
  const std::vector<bool>& known() const override { return known_; }

 private:
  void setCoordinates(const Motion& motion, const SampleShifts& shifts);
  void setOrientations(const Motion& motion);
  void shiftTurns(const Motion& motion, const SampleShifts& shifts);
  void setRoots(const Motion& motion, const SampleShifts& shifts);
  void setRootsByLink(const Motion& motion, const SampleShifts& shifts);
  void setRoot(std::size_t sample, const RootMotion& root);
  void setLoads(const Motion& motion, const SampleShifts& shifts, const LoadLaw& law);

  const Mechanism& mechanism_;
  const InverseDynamics& dynamics_;
  const ShiftPlan& plan_;
  BlockInverseDynamics<double> block_;
  std::size_t samples_;  // whole packs of vector instructions
  std::vector<double> inputs_, root_, orientations_, outputs_;
  ResultBlock<double> results_;
  Motion shifted_;  // a sample
  RootByLink root_by_link_;
  std::vector<Load> loads_;  // of the samples
  std::vector<bool> known_;
};

/// Samples of closed loops: independent coordinates are shifted, and the others follow. The samples
/// of shifts of the others are not computed.
class ShiftedLoops : public ShiftedSamples {
 public:
  /// @param dynamics must outlive it, like mechanism and plan
  /// @param own the scene's load
  ShiftedLoops(const Mechanism& mechanism, const ClosedLoopDynamics& dynamics,
               const ShiftPlan& plan, const Load& own, const IndependentCoordinates& independent);

  void compute(const Motion& motion, const SampleShifts& shifts, const LoadLaw& law) override;
  const double* values(std::size_t number) const override {
    return values_.data() + number * samples_;
  }
  const std::vector<bool>& known() const override { return known_; }

 private:
  bool complete();
  bool computeSample(std::size_t sample, const LoadLaw& law, int shifted_wrench = -1);
  void setLink(const Motion& motion, const SampleShifts& shifts);
  bool computeCoordinates(const Motion& motion, const SampleShifts& shifts, const LoadLaw& law);

  const Mechanism& mechanism_;
  const ClosedLoopDynamics& dynamics_;
  const ShiftPlan& plan_;
  const IndependentCoordinates independent_;
  const bool positions_first_;  // as more of them are independent than of the rates
  ClosedLoopDynamics::Workspace workspace_;
  const ResultNumbers numbers_;
  const std::size_t samples_;
  Motion shifted_;
  Load load_;  // of shifted_
  RootByLink root_by_link_;
  int root_link_ = 0;  // that of the shifts
  RootMotion link_;    // its motion in the sample
  Eigen::VectorXd wrench_shifts_;
  std::vector<double> values_;
  std::vector<bool> known_;
};

}  // namespace virtual_work_dynamics
