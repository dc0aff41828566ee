#pragma once

#include <cstddef>
#include <cstdint>

#include "motion/block_record.h"
#include "motion/shown_noise.h"
#include "motion/stream_identification.h"
#include "motion/stream_model.h"
#include "virtual_work_dynamics/noise_settings.h"

namespace virtual_work_dynamics {

/// Holds the model of the samples of one coordinate, and improves it as they come: assumed from
/// what the first samples show, then the one under which blocks of the latest seconds are most
/// likely (StreamIdentification), loosened at once where samples contradict it. What the settings
/// give is never changed. Does not allocate after construction.
class StreamLearner {
 public:
  /// Derivative of the motion that is white noise.
  static constexpr int kOrder = 4;

  /// @param max_gap ns between samples, across which nothing is assumed of the motion.
  /// @param learns false: no blocks are recorded, and record() and identify() are not called.
  StreamLearner(const NoiseSettings& settings, std::int64_t max_gap, bool learns);

  const StreamModel& model() const { return model_; }
  /// Whether the settings leave noise or bandwidth to be found.
  bool finds() const { return settings_.position_noise < 0 || settings_.bandwidth <= 0; }
  /// Whether the model was found from blocks of samples.
  bool learnt() const { return learnt_; }
  /// Velocities over slopes of the positions where they contradict each other; 1: they do not.
  double velocityRatio() const { return velocity_ratio_; }

  /// Takes for the model what can be assumed before anything is learnt.
  /// @param interval s, usual time between samples.
  void assume(const ShownNoise& shown, double interval);
  /// Makes the positions of the model no better than this standard deviation, rad or m.
  void raise(double least_position);

  /// Lets the motion change faster: innovations follow each other on one side. Returns whether the
  /// settings leave that open; the next identification then comes soon.
  /// @param interval s, usual time between samples.
  bool quicken(double interval);
  /// Multiplies the variances of positions and motion. Returns whether the settings leave that
  /// open; the next identification then comes soon.
  bool worsen(double factor);

  /// Adds a sample to the record, as BlockRecord::add().
  void record(std::int64_t stamp, double position, double velocity, int stretch, double interval) {
    record_.add(stamp, position, velocity, stretch, interval);
  }
  /// Begins another stretch of samples.
  void beginStretch() { record_.beginStretch(); }
  /// Forgets the record, and an identification that is under way; keeps the model.
  void forgetRecord();
  /// Forgets the record, and takes the model for one that was not learnt.
  void unlearn();

  /// Goes on with finding a model from the record by as much as is due with one sample. Returns
  /// whether model() is another one now.
  /// @param least_position rad or m, standard deviation that no position can be better than.
  /// @param interval s, usual time between samples.
  bool identify(double least_position, double interval);

 private:
  void startIdentification(double least_position, double interval);
  void judge(double least_position);
  StreamKnowledge knowledge(double least_position) const;

  const NoiseSettings settings_;
  const std::int64_t max_gap_;
  StreamModel model_;
  bool learnt_ = false;
  bool velocities_proven_ = false;
  double velocity_ratio_ = 1;
  BlockRecord record_;
  std::size_t wanted_blocks_ = StreamIdentification::kFewest;  // fresh ones, before the next
  StreamIdentification identification_;
};

}  // namespace virtual_work_dynamics
