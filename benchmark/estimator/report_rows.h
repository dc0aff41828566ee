#pragma once

#include <cstdio>
#include <functional>
#include <string>

#include "estimator/encoder_stream.h"

namespace virtual_work_dynamics {

/// Rows of the report's CSV: one figure each.
class ReportRows {
 public:
  static constexpr const char* kHeader =
      "part,group,rate_hz,quantum_rad,velocities,jitter_ms,method,lag_ms,quantity,value\n";

  /// @param write receives each row with its end of line.
  explicit ReportRows(std::function<void(const std::string&)> write) : write_(std::move(write)) {}

  /// @param lag_ms negative: none.
  void add(const char* part, const StreamSpec& spec, const std::string& method, double lag_ms,
           const char* quantity, double value) const {
    char text[256];
    std::snprintf(text, sizeof text, "%s,%s,%d,%g,%s,%g,%s,%g,%s,%.6g\n", part, spec.group.c_str(),
                  spec.rate, spec.quantum, velocityName(spec.velocity), 1e3 * spec.jitter,
                  method.c_str(), lag_ms, quantity, value);
    write_(text);
  }

 private:
  static const char* velocityName(VelocityKind kind) {
    constexpr const char* kNames[] = {"none", "good", "zero", "degrees", "too_large", "noisy"};
    return kNames[static_cast<int>(kind)];
  }

  std::function<void(const std::string&)> write_;
};

}  // namespace virtual_work_dynamics
