#pragma once

#include <cstdint>
#include <random>

namespace virtual_work_dynamics {

/// The standard's distributions give other numbers with another library; the engine does not.
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint32_t seed) : engine_(seed) {}

  /// Of 53 bits.
  double uniform(double low, double high) {
    const double coarse = static_cast<double>(engine_());
    const double fine = static_cast<double>(engine_() >> 11);
    return low + (high - low) * ((coarse * 2097152.0 + fine) / 9007199254740992.0);
  }
  bool chance(double share) { return uniform(0, 1) < share; }

 private:
  std::mt19937 engine_;
};

}  // namespace virtual_work_dynamics
