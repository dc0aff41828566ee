#include "motion/stream_learner.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "motion/sample_blocks.h"
#include "motion/velocity_judge.h"

namespace virtual_work_dynamics {
namespace {

/// Before anything is learnt, the time constant is one with which noise of the positions makes so
/// much acceleration, rad/s^2 or m/s^2, within these bounds, s and intervals.
constexpr double kFirstAcceleration = 0.1;
constexpr double kLongestFirstTime = 0.05;
constexpr double kShortestFirstIntervals = 1.5;
/// The shortest one where the motion is what moves the samples off a cubic.
constexpr double kFollowingIntervals = 0.5;
/// A model is no stiffer than this, so that a motion that begins is not overlooked.
constexpr double kLongestTime = 1.0;  // s
/// Part of the time of the blocks that a time constant found from them can be: what swings by one
/// radian in this time has to be seen for a whole swing.
constexpr double kLongestPart = 1.0 / 6;

/// Shortest time constant that quicken() leads to, s and intervals; less has to be learnt.
constexpr double kQuickTime = 0.004;
constexpr double kQuickIntervals = 0.5;
/// The factor by which the density of the motion then grows.
constexpr double kBoost = 10;

/// Steps of the identification for each second that samples are apart: a part of the time that
/// depends neither on the rate nor on what is found.
constexpr double kStepsPerSecond = 80000;
constexpr double kMostSteps = 800;
/// A joint moves when it moves by so many deviations of its positions.
constexpr double kMovingSteps = 30;
/// Blocks that noise is learnt from at rest.
constexpr std::size_t kBlocksOfRest = 4 * StreamIdentification::kFewest;
/// Blocks at speed, that is with steps of so many deviations, before noise of stamps is learnt: at
/// rest it has no effect, and where a joint sets off it would explain the acceleration.
constexpr int kBlocksAtSpeed = 64;
constexpr double kStepsAtSpeed = 3;

/// Time constant before anything is learnt of the motion, s.
double firstTime(double position_noise, double interval, bool follow) {
  const double shortest = (follow ? kFollowingIntervals : kShortestFirstIntervals) * interval;
  const double time =
      std::pow(std::pow(position_noise / kFirstAcceleration, 2) * interval, 1.0 / 5);
  return std::max(std::min(time, kLongestFirstTime), shortest);
}

/// How far a joint went within some blocks.
struct Travel {
  double range = 0;  // rad or m, from the least position to the most
  int at_speed = 0;  // blocks with steps of at least kStepsAtSpeed deviations
};

Travel travelOf(const std::vector<StreamBlock>& blocks, double deviation) {
  double least = blocks[0].position;
  double most = least;
  Travel travel;
  for (std::size_t i = 1; i < blocks.size(); ++i) {
    least = std::min(least, blocks[i].position);
    most = std::max(most, blocks[i].position);
    const double step = std::abs(blocks[i].position - blocks[i - 1].position);
    travel.at_speed += step > kStepsAtSpeed * deviation ? 1 : 0;
  }
  travel.range = most - least;
  return travel;
}

}  // namespace

StreamLearner::StreamLearner(const NoiseSettings& settings, std::int64_t max_gap, bool learns)
    : settings_(settings), max_gap_(max_gap) {
  if (!learns) return;
  record_.reserve();
  identification_.reserve(BlockRecord::kMost);
}

void StreamLearner::assume(const ShownNoise& shown, double interval) {
  StreamKnowledge knowledge;
  knowledge.least_position = shown.least();
  knowledge.position_noise = settings_.position_noise;
  if (knowledge.position_noise < 0) knowledge.position_noise = shown.deviation();
  knowledge.stamp_noise = settings_.stamp_noise;
  knowledge.use_velocities = false;
  const double noise = std::max(knowledge.position_noise, knowledge.least_position);
  knowledge.time_constant = settings_.bandwidth > 0 ? bandwidthOf(settings_.bandwidth)
                                                    : firstTime(noise, interval, shown.ofMotion());
  model_ = unlearnt(knowledge, interval);
}

void StreamLearner::raise(double least_position) {
  model_.position_variance = std::max(model_.position_variance, least_position * least_position);
}

bool StreamLearner::quicken(double interval) {
  if (settings_.bandwidth > 0) return false;
  const double quickest = std::max(kQuickTime, kQuickIntervals * interval);
  const double most = densityFor(quickest, model_.position_variance, kOrder, interval);
  model_.density = std::max(model_.density, std::min(kBoost * model_.density, most));
  wanted_blocks_ = std::min(wanted_blocks_, StreamIdentification::kFewest);
  return true;
}

bool StreamLearner::worsen(double factor) {
  if (settings_.position_noise >= 0) return false;
  model_.position_variance *= factor;
  model_.density *= factor;
  wanted_blocks_ = std::min(wanted_blocks_, StreamIdentification::kFewest);
  return true;
}

void StreamLearner::forgetRecord() {
  record_.clear();
  wanted_blocks_ = StreamIdentification::kFewest;
  identification_.stop();
}

void StreamLearner::unlearn() {
  learnt_ = false;
  forgetRecord();
}

bool StreamLearner::identify(double least_position, double interval) {
  constexpr std::size_t kFewest = StreamIdentification::kFewest;
  if (!identification_.running()) {
    if (record_.fresh() >= wanted_blocks_ && record_.count() >= kFewest)
      startIdentification(least_position, interval);
    return false;
  }
  const double steps = std::min(kStepsPerSecond * interval, kMostSteps);
  if (!identification_.advance(1 + static_cast<int>(steps))) return false;
  model_ = identification_.model();
  learnt_ = true;
  return true;
}

void StreamLearner::startIdentification(double least_position, double interval) {
  std::vector<StreamBlock>& blocks = identification_.blocks();
  record_.copyTo(blocks);
  wanted_blocks_ =
      std::min(std::max(record_.count(), StreamIdentification::kFewest), BlockRecord::kMost / 2);
  const double deviation = std::max(least_position, std::sqrt(model_.position_variance));
  const Travel travel = travelOf(blocks, deviation);
  if (travel.range == 0) {
    // There is nothing to learn; a motion that begins shall not wait behind the rest.
    record_.keep(StreamIdentification::kFewest);
    wanted_blocks_ = StreamIdentification::kFewest / 2;
    return;
  }
  // At rest there is only noise to compare.
  if (travel.range >= kMovingSteps * deviation) judge(least_position);
  StreamKnowledge known = knowledge(least_position);
  if (settings_.stamp_noise < 0 && travel.at_speed < kBlocksAtSpeed) {
    known.stamp_noise = learnt_ ? std::sqrt(model_.stamp_variance) : 0;
    wanted_blocks_ = StreamIdentification::kFewest;
  }
  if (settings_.bandwidth > 0) {
    known.time_constant = bandwidthOf(settings_.bandwidth);
  } else if (travel.range < kMovingSteps * deviation) {
    // At rest noise can be learnt, but not how fast the joint will move; nor shall that wait behind
    // the rest.
    const double first = firstTime(std::sqrt(model_.position_variance), interval, false);
    known.time_constant = std::max(timeConstant(model_, kOrder, interval), first);
    record_.keep(kBlocksOfRest);
    blocks.erase(blocks.begin(), blocks.end() - static_cast<std::ptrdiff_t>(record_.count()));
    wanted_blocks_ = StreamIdentification::kFewest;
  }
  identification_.start(known, record_.interval(), record_.samples(), learnt_ ? &model_ : nullptr);
}

/// Judges from the blocks of the identification whether velocities may be used.
void StreamLearner::judge(double least_position) {
  const VelocityJudgement judgement =
      judgeVelocities(identification_.blocks(), record_.interval(), least_position);
  if (!judgement.moved) return;
  velocities_proven_ = judgement.agree;
  velocity_ratio_ = judgement.agree ? 1 : judgement.ratio;
}

/// What settings and samples say before the identification, of a joint that moves.
StreamKnowledge StreamLearner::knowledge(double least_position) const {
  StreamKnowledge known;
  known.order = kOrder;
  known.least_position = least_position;
  known.position_noise = settings_.position_noise;
  known.velocity_noise = settings_.velocity_noise;
  known.stamp_noise = settings_.stamp_noise;
  known.use_velocities = settings_.use_velocity && velocities_proven_;
  const auto blocks = static_cast<double>(record_.count());
  known.longest_time = std::min(kLongestTime, kLongestPart * record_.interval() * blocks);
  known.longest_gap = std::max(static_cast<double>(max_gap_) * 1e-9, 2.5 * record_.interval());
  return known;
}

}  // namespace virtual_work_dynamics
