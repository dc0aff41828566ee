#pragma once

#include <ros/advertise_options.h>
#include <ros/publisher.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ros/deviation_record.h"
#include "ros/effort_measurements.h"
#include "ros/message_recorder.h"
#include "ros/root_settings.h"
#include "ros/threshold_record.h"
#include "ros/trajectory_conversion.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/motion_covariance.h"

namespace virtual_work_dynamics {

/// One computed sample.
struct OutputSample {
  std::int64_t stamp_ns;  ///< instant of the motion
  const Motion& motion;
  const Results& results;
  const MotionCovariance* covariance = nullptr;  ///< of the motion; null: not known
  const LoadLaw* law = nullptr;                  ///< of the load of the sample; null: the scene's
  bool measured = false;  ///< whether joint states say so, rather than a trajectory
};

/// The message of one output in one plan, with names, frames and sizes set once. Only the computing
/// thread uses it.
class OutputMessage {
 public:
  virtual ~OutputMessage() = default;

  /// Begins a trajectory, whose points the next samples are; for outputs of trajectories.
  virtual void begin(const trajectory_msgs::JointTrajectory&, const TrajectoryMotion&) {}
  /// Writes a sample. Allocates only while or after some result does not exist, and for
  /// trajectories.
  virtual void fill(const OutputSample& sample) = 0;
  /// Publishes what was written, unless there is nothing to publish.
  virtual void publish(const ros::Publisher& topic) const = 0;
  /// Records what publish() would publish.
  virtual void record(MessageRecorder& recorder) const = 0;
};

/// A message of one type, published when what was written has a value.
template <typename Message>
class MessageOf : public OutputMessage {
 public:
  const Message& message() const { return message_; }
  /// Whether what was written last has a value.
  bool exists() const { return exists_; }
  void publish(const ros::Publisher& topic) const override {
    if (exists_) topic.publish(message_);
  }
  void record(MessageRecorder& recorder) const override {
    if (exists_) recorder.record(message_);
  }

 protected:
  Message message_;
  bool exists_ = true;
};

/// An output of the node: its topic, what has to be computed for its subscribers, and the message
/// for the results. Everything about an output is in one class, in outputs.cpp or a file of its
/// own, with one line in makeOutputs().
class Output {
 public:
  virtual ~Output() = default;

  /// Name of the topic, below the node's own.
  virtual std::string topic() const = 0;
  /// How it is advertised, without callbacks for subscribers.
  virtual ros::AdvertiseOptions options(const std::string& topic, std::uint32_t queue) const = 0;
  /// Publishes what a latched topic says before the first sample.
  virtual void start(const ros::Publisher&) const {}
  /// Records what start() would publish.
  virtual void recordStart(MessageRecorder&) const {}

  /// Whether it has one message for each trajectory, rather than for each sample.
  virtual bool ofTrajectories() const { return false; }
  /// Whether it is to be looked at while it comes, at a rate by the clock on the wall, and so is
  /// not recorded.
  virtual bool isForLooking() const { return false; }
  /// Whether it says how far results may be off, which recordings have when asked for.
  virtual bool ofDeviations() const { return false; }
  /// Whether it needs measured efforts, which recordings compare when asked for.
  virtual bool ofMeasuredEfforts() const { return false; }
  /// Whether it is computed even if nobody listens, as something is watched by it.
  virtual bool isAlwaysComputed() const { return false; }
  /// Whether its message uses OutputSample::covariance.
  virtual bool usesCovariance() const { return false; }
  /// Adds what its subscribers need.
  virtual void addTo(Request& request) const = 0;
  /// Its message in a plan whose request has what addTo() adds.
  /// @param scene that the plan was compiled of: payloads and gravity may change
  virtual std::unique_ptr<OutputMessage> makeMessage(const Dynamics& plan,
                                                     const Scene& scene) const = 0;
};

using Outputs = std::vector<std::unique_ptr<Output>>;

/// What outputs depend on in addition to the plan.
struct OutputSettings {
  std::vector<std::string> reactions;        ///< joints and closures that the scene asks for
  std::vector<std::string> reaction_topics;  ///< their topics
  std::string frame_prefix;                  ///< put before every frame_id
  bool twist = false;                        ///< whether ~reactions has twists
  double condition_warn = kCloseToSingular;  ///< a larger condition is close to a singular position
  Scene scene;                               ///< whose closures and springs are shown
  std::shared_ptr<DeviationRecord> deviations;  ///< what they are recorded in; null: no deviations
  double marker_rate = 20;                      ///< largest one of ~markers and /tf, Hz
  RootSettings root{};                          ///< in which axes reactions are
  std::shared_ptr<EffortMeasurements> efforts{};  ///< null: nothing is measured
  std::shared_ptr<ThresholdRecord> external{};    ///< of external efforts; null: no thresholds
  std::shared_ptr<ThresholdRecord> limits{};      ///< of efforts; null: limits are not looked at
  bool external_observed = false;                 ///< whether `external` is of ~external_effort
  double observer_gain = 0;  ///< of ~external_effort, 1/s; 0: it is not offered
  double max_gap = 0.25;     ///< s, after which an observer starts anew
};

/// All outputs of the node for a mechanism and a scene.
/// @param everything Dynamics of all that the scene asks for.
Outputs makeOutputs(const Mechanism& mechanism, const Dynamics& everything,
                    const OutputSettings& settings);

/// Indices of the outputs that somebody listens to, ascending.
using Audience = std::vector<std::size_t>;

/// The request of exactly what an audience needs.
Request requestFor(const Outputs& outputs, const Audience& audience);

}  // namespace virtual_work_dynamics
