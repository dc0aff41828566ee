#pragma once

#include <atomic>
#include <cstddef>
#include <utility>
#include <vector>

#include "dynamics/contact_gaps.h"
#include "ros/scene_inputs.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Starts the assembly of a scene at a position, so that what sticks there does so where it is.
/// @param contacts indices of closures that stick
/// @throws SceneError naming one that would nevertheless stick elsewhere; as Dynamics does, where
///   the scene is refused.
void placeContacts(const Mechanism& mechanism, const Motion& at,
                   const std::vector<std::size_t>& contacts, Scene& scene);

/// Hands a motion from the computing thread to another one that asks for it. The computing side
/// neither waits nor allocates.
class MotionSlot {
 public:
  /// @param motion of the size of those that come
  explicit MotionSlot(Motion motion) : motion_(std::move(motion)) {}

  /// For the asking thread: wants the next motion, unless one is here or on its way.
  void ask() {
    State empty = State::kEmpty;
    state_.compare_exchange_strong(empty, State::kAsked);
  }
  /// For the asking thread: the motion that came; null: none did.
  const Motion* motion() const {
    return state_.load(std::memory_order_acquire) == State::kFull ? &motion_ : nullptr;
  }
  /// For the asking thread: has no more use for the motion.
  void clear() {
    if (motion()) state_.store(State::kEmpty);
  }
  /// For the computing thread: a motion, which is copied if it was asked for.
  void offer(const Motion& motion) {
    if (state_.load(std::memory_order_acquire) != State::kAsked) return;
    motion_ = motion;
    state_.store(State::kFull, std::memory_order_release);
  }

 private:
  enum class State { kEmpty, kAsked, kFull };

  std::atomic<State> state_{State::kEmpty};
  Motion motion_;
};

/// Hands what contacts with gaps come to from the computing thread to the one that compiles. The
/// computing side neither waits nor allocates.
class GapRecord {
 public:
  /// @throws SceneError as ContactGaps
  GapRecord(const Mechanism& mechanism, const Scene& scene)
      : gaps_(mechanism, scene), found_(gaps_.contacts().size()) {}

  /// For the computing thread: a motion that is computed.
  void take(const Motion& motion) {
    const bool again = refused_.load(std::memory_order_relaxed) && ++waited_ >= kAgain;
    if (!gaps_.take(motion) && !again) return;
    waited_ = 0;
    for (std::size_t i = 0; i < found_.size(); ++i) {
      found_[i].closed.store(gaps_.contacts()[i].closed, std::memory_order_relaxed);
      found_[i].height.store(gaps_.contacts()[i].height, std::memory_order_relaxed);
    }
    news_.store(true, std::memory_order_release);
  }
  /// For the compiling thread: sets them in a scene that changes, where one has changed, and
  /// returns whether one has, or one that was refused is to be tried again.
  bool hand(SceneInputs& scene) {
    if (found_.empty()) return false;
    refused_.store(scene.refused(), std::memory_order_relaxed);
    if (!news_.exchange(false, std::memory_order_acquire)) return false;
    for (std::size_t i = 0; i < found_.size(); ++i) {
      const double height = found_[i].height.load(std::memory_order_relaxed);
      scene.setContact(gaps_.contacts()[i].closure,
                       found_[i].closed.load(std::memory_order_relaxed), gaps_.surface(i, height));
    }
    scene.tryAgain();
    return true;
  }

 private:
  // After so many samples what was refused is tried again: the robot moves on.
  static constexpr int kAgain = 100;
  struct Found {
    std::atomic<bool> closed{false};
    std::atomic<double> height{0};
  };

  ContactGaps gaps_;
  std::vector<Found> found_;  // by contact of gaps_
  int waited_ = 0;            // samples, with what is refused
  std::atomic<bool> news_{false}, refused_{false};
};

}  // namespace virtual_work_dynamics
