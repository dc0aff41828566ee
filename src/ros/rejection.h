#pragma once

#include <array>
#include <cstddef>
#include <string>

namespace virtual_work_dynamics {

/// Why a message was dropped, or a sample not published.
enum class DropReason : std::size_t {
  kArrayLength,
  kNotFinite,
  kNoKnownJoint,
  kJointTwice,
  kZeroStamp,
  kEqualStamp,
  kTooLate,
  kNoPoints,
  kTimes,
  kNeverSeen,
  kOverflow,
  kPassiveJoints,
  kOpenLoop,
  kNoTime,
  kBacklog,
  kUnknownFrame,
  kNoWrench,
  kOrientation,
  kNoRoot,
  kNoBody,
  kNoTurn,
  kNoDrive,
  kInternal
};

/// The reasons as diagnostics show them, in the order of DropReason.
constexpr std::array<const char*, 23> kDropReasonNames = {
    "array length",   "not finite",     "no known joint", "joint twice",    "zero stamp",
    "equal stamp",    "too late",       "no points",      "times",          "joint never seen",
    "overflow",       "passive joints", "open loop",      "no time yet",    "backlog",
    "unknown frame",  "no wrench",      "orientation",    "no root motion", "no such body",
    "no orientation", "drive",          "internal"};

constexpr std::size_t index(DropReason reason) {
  return static_cast<std::size_t>(reason);
}

/// Whether it is a result that is dropped, rather than a message.
constexpr bool concernsResult(DropReason reason) {
  return reason == DropReason::kOverflow || reason == DropReason::kOpenLoop ||
         reason == DropReason::kNoWrench || reason == DropReason::kNoRoot ||
         reason == DropReason::kNoTurn || reason == DropReason::kNoDrive;
}

/// Why a message is dropped, with a line that names the culprit.
struct Rejection {
  DropReason reason;
  std::string text;
};

}  // namespace virtual_work_dynamics
