#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "generated_cases.h"
#include "generated_program.h"
#include "virtual_work_dynamics/closed_loop_dynamics.h"
#include "virtual_work_dynamics/inverse_dynamics.h"

namespace virtual_work_dynamics {

/// A scene with loops whose code is generated and compared with the library.
class GeneratedLoops {
 public:
  GeneratedLoops(const Mechanism& mechanism, const Scene& scene, bool child_axes)
      : mechanism_(mechanism), scene_(scene) {
    (child_axes ? request_.child_axes : request_.root_axes) = requestedReactions(mechanism, scene);
    request_.determinacy = true;
    dynamics_.emplace(mechanism, scene, request_);
    workspace_ = std::make_unique<ClosedLoopDynamics::Workspace>(dynamics_->makeWorkspace());
    code_ = generateCode(mechanism, scene, request_, options_);
  }

  const ClosedLoopDynamics& dynamics() const { return *dynamics_; }
  const GeneratedCode& code() const { return code_; }
  ClosedLoopDynamics::Workspace& workspace() { return *workspace_; }
  void divide(std::size_t operations) {
    options_.operations_of_function = operations;
    code_ = generateCode(mechanism_, scene_, request_, options_);
  }

  /// Adds a sample and what the library says of it.
  void add(const Motion& motion, std::mt19937& generator) {
    std::vector<double> row;
    for (const Eigen::VectorXd* part : {&motion.q, &motion.qd, &motion.qdd}) append(row, *part);
    if (scene_.root_moves) {
      const RootState state =
          InverseDynamics(mechanism_, dynamics_->tree(), Request()).rootState(motion.root);
      row.insert(row.end(), state.data(), state.data() + RootState::kNumbers);
    }
    Load load(scene_);
    std::uniform_real_distribution<double> uniform(-5, 5);
    for (Wrench& wrench : load.wrenches) {
      for (int i = 0; i < 3; ++i) wrench.force[i] = uniform(generator);
      for (int i = 0; i < 3; ++i) wrench.torque[i] = uniform(generator);
      append(row, wrench.force);
      append(row, wrench.torque);
    }
    dynamics_->compute(motion, load, *workspace_);
    rows_.insert(rows_.end(), row.begin(), row.end());
    const Results& results = workspace_->results();
    Sample sample;
    append(sample.expected, results.effort);
    for (const auto* wrenches : {&results.child_axes, &results.root_axes}) {
      for (const Wrench& wrench : *wrenches) {
        append(sample.expected, wrench.force);
        append(sample.expected, wrench.torque);
      }
    }
    const std::vector<bool>& determined = results.loops.effort_determined;
    sample.singular = results.singular() || results.undirected() ||
                      std::count(determined.begin(), determined.end(), false) > 0;
    sample.condition = 1;
    for (const double condition : results.loops.closure_conditions) {
      sample.condition = std::max(sample.condition, condition);
    }
    sample.finite = results.finite();
    samples_.push_back(std::move(sample));
  }
  /// A random motion about `q`, which closes loops or not: forces do not need that.
  Motion motionAbout(const Eigen::VectorXd& q, double far, std::mt19937& generator) const {
    std::uniform_real_distribution<double> uniform(-1, 1);
    Motion motion(dynamics_->coordinates());
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      motion.q[i] = q[i] + far * uniform(generator);
      motion.qd[i] = 3 * uniform(generator);
      motion.qdd[i] = 3 * uniform(generator);
    }
    motion.root.angular_velocity = Eigen::Vector3d(0.3, -0.2, uniform(generator));
    motion.root.acceleration = Eigen::Vector3d(uniform(generator), 0.5, 3);
    return motion;
  }

  /// Adds the samples of a search, along the line from one motion to another, for where the
  /// condition is worst: conditions grow from step to step, if there is a singular position.
  /// Returns the number of samples whose rank is in doubt.
  int addTowardsSingular(const Motion& from, const Motion& to, std::mt19937& generator) {
    constexpr int kPieces = 40, kSteps = 45;
    constexpr double kGolden = 0.381966;
    int doubtful = 0;
    const auto goodness = [&](double t) {
      Motion motion = from;
      motion.q = from.q + t * (to.q - from.q);
      add(motion, generator);
      const Sample& sample = samples_.back();
      const bool doubt = sample.singular || sample.condition > kSure;
      doubtful += doubt ? 1 : 0;
      return sample.singular ? 0 : 1 / sample.condition;
    };
    int worst = 0;
    double least = 2;
    for (int i = 0; i <= kPieces; ++i) {
      const double good = goodness(static_cast<double>(i) / kPieces);
      if (good < least) worst = i;
      least = std::min(least, good);
    }
    double low = (worst - 1.0) / kPieces, high = (worst + 1.0) / kPieces;
    for (int i = 0; i < kSteps; ++i) {
      const double a = low + kGolden * (high - low), b = high - kGolden * (high - low);
      (goodness(a) < goodness(b) ? high : low) = goodness(a) < goodness(b) ? b : a;
    }
    return doubtful;
  }

  /// What was found when the compiled code was run on all samples, of one and in blocks.
  struct Finding {
    std::string compiler;             ///< what it said
    std::size_t samples = 0;          ///< computed twice each
    std::size_t computed = 0;         ///< with status 0 or 1
    std::size_t differences = 0;      ///< in results of these
    std::size_t unsaid = 0;           ///< singular ones, and ones not finite, without status 2
    std::size_t wrongly_close = 0;    ///< status 1 or 0 where the condition says the other
    std::size_t refused_regular = 0;  ///< status 2 although the package is sure of the rank
    std::size_t not_zero = 0;         ///< results where the status is 2
    /// The largest error of a result, in roundings of the largest one, times the condition.
    double error = 0;
  };

  /// @param fused whether products are fused, as the library's are
  Finding run(const std::string& compiler, const std::string& options, bool fused = true) {
    Finding found;
    GeneratedProgram program(code_, options_.name, inputs(), outputs(), true);
    found.compiler = program.compile(
        compiler, options + optionsFor(fused ? comparedInstructions() : InstructionSet::kBaseline));
    if (!found.compiler.empty()) return found;
    const std::vector<double> made = program.run(rows_);
    const std::size_t count = samples_.front().expected.size() + 1;
    EXPECT_EQ(made.size(), 2 * count * samples_.size());
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      judge(samples_[i], made.data() + 2 * i * count, found);
      judge(samples_[i], made.data() + (2 * i + 1) * count, found);
    }
    found.samples = samples_.size();
    return found;
  }
  std::vector<int> inputs() const {
    GeneratedCase of{mechanism_, scene_, request_, 0};
    return inputCounts(of);
  }
  std::vector<int> outputs() const {
    std::vector<int> counts;
    counts.push_back(static_cast<int>(workspace_->results().effort.size()));
    for (const auto* names : {&request_.child_axes, &request_.root_axes}) {
      if (!names->empty()) counts.push_back(static_cast<int>(6 * names->size()));
    }
    return counts;
  }

 private:
  struct Sample {
    std::vector<double> expected;
    bool singular = false;  // or efforts are not determined
    bool finite = true;
    double condition = 1;
  };

  // Beyond this the package looks at the rank anew: MultifrontalQr::sureCondition() for the default
  // tolerance.
  static constexpr double kSure = 1e6;

  static void judge(const Sample& sample, const double* made, Finding& found) {
    const std::size_t count = sample.expected.size();
    const double status = made[count];
    if (status == 2) {
      if (!sample.singular && sample.finite && sample.condition <= kSure) ++found.refused_regular;
      found.not_zero += static_cast<std::size_t>(
          std::count_if(made, made + count, [](double value) { return !(value == 0); }));
      return;
    }
    ++found.computed;
    if (sample.singular || !sample.finite) ++found.unsaid;
    if (status != (sample.condition > kCloseToSingular ? 1 : 0)) ++found.wrongly_close;
    double error = 0, largest = std::numeric_limits<double>::min();
    for (std::size_t i = 0; i < count; ++i) {
      if (!(made[i] == sample.expected[i])) ++found.differences;
      largest = std::max(largest, std::abs(sample.expected[i]));
      error = std::max(error, std::abs(made[i] - sample.expected[i]));
    }
    const double rounding = std::numeric_limits<double>::epsilon() * largest * sample.condition;
    found.error = std::max(found.error, error / rounding);
  }

  Mechanism mechanism_;
  Scene scene_;
  Request request_;
  GeneratedCodeOptions options_;
  std::optional<ClosedLoopDynamics> dynamics_;
  std::unique_ptr<ClosedLoopDynamics::Workspace> workspace_;
  GeneratedCode code_;
  std::vector<double> rows_;
  std::vector<Sample> samples_;
};

}  // namespace virtual_work_dynamics
