#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace virtual_work_dynamics {

/// Waits for another thread to make the condition true. The time limit is only for conditions that
/// never come true.
template <typename Condition>
void waitUntil(const Condition& condition) {
  constexpr std::chrono::seconds kPatience{90};
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!condition()) {
    ASSERT_LT(std::chrono::steady_clock::now(), end);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace virtual_work_dynamics
