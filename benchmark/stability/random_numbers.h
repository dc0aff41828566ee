#pragma once

#include <cstdint>
#include <random>

namespace virtual_work_dynamics {

/// Random numbers that are the same with every standard library, as its engine's are but not those
/// of its distributions.
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint32_t seed) : engine_(seed) {}

  /// A number of 53 random bits between `low` and `high`.
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
