#include "ros/free_joints.h"

#include <limits>

#include "virtual_work_dynamics/free_turn.h"

namespace virtual_work_dynamics {

FreeJoints::FreeJoints(const Mechanism& mechanism, const EstimatorSettings& settings)
    : mechanism_(mechanism), conversion_(mechanism) {
  for (std::size_t i = 0; i < mechanism.orientations(); ++i) {
    turns_.emplace_back(settings);
    slides_.emplace_back();
    const CompoundJoint& joint = mechanism.freeJoint(i);
    if (joint.type != CompoundType::kFloating) continue;
    for (const char* axis : {".x", ".y", ".z"})
      slides_.back().push_back(mechanism.coordinateIndex(joint.name + axis));
  }
  samples_.reserve(turns_.size());
  for (auto* numbers : {&q_, &qd_}) numbers->reserve(6 * turns_.size());
  coordinates_.reserve(6 * turns_.size());
}

std::optional<Rejection> FreeJoints::take(const sensor_msgs::MultiDOFJointState& message,
                                          JointSample& sample) {
  if (auto rejection = conversion_.convert(message, samples_)) return rejection;
  coordinates_.clear();
  q_.clear();
  qd_.clear();
  const auto add = [&](int coordinate, double q, double qd) {
    coordinates_.push_back(coordinate);
    q_.push_back(q);
    qd_.push_back(qd);
  };
  for (const FreeJointSample& each : samples_) {
    // What it says of the stamp, the estimator of the other coordinates says, too.
    turns_[each.orientation].push(each.turn);
    for (int axis = 0; axis < 3; ++axis) {
      add(mechanism_.anglesOf(each.orientation) + axis, 0,
          std::numeric_limits<double>::quiet_NaN());
      const std::vector<int>& slides = slides_[each.orientation];
      if (slides.empty()) continue;
      add(slides[static_cast<std::size_t>(axis)], each.position[axis], each.velocity[axis]);
    }
  }
  sample = JointSample();
  sample.stamp_ns = samples_.front().turn.stamp_ns;
  sample.count = static_cast<int>(coordinates_.size());
  sample.coordinates = coordinates_.data();
  sample.q = q_.data();
  sample.qd = qd_.data();
  return std::nullopt;
}

void FreeJoints::restart(std::int64_t stamp_ns) {
  for (TurnEstimator& turn : turns_) {
    if (!turn.empty() && turn.last() > stamp_ns) turn.restart();
  }
}

std::optional<std::size_t> FreeJoints::set(std::int64_t stamp_ns, const MotionEstimator& estimator,
                                           const std::vector<bool>& needed, Motion& motion,
                                           MotionCovariance* covariance) const {
  for (std::size_t i = 0; i < turns_.size(); ++i) {
    if (!needed[static_cast<std::size_t>(mechanism_.anglesOf(i))]) continue;
    FreeTurn turn;
    TurnCovariance* const own = covariance ? &covariance->turns[i] : nullptr;
    if (!turns_[i].read(stamp_ns, turn, own)) {
      if (turns_[i].empty() || !estimator.held(mechanism_.anglesOf(i))) return i;
      turn = turns_[i].heldAt(stamp_ns);
    }
    setFreeTurn(mechanism_, i, turn, motion);
  }
  return std::nullopt;
}

}  // namespace virtual_work_dynamics
