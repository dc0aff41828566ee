#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace virtual_work_dynamics {

struct StabilityOptions {
  std::string output;               ///< empty: no table as CSV
  std::string details;              ///< empty: no table of what is measured of double alone
  std::vector<std::string> scenes;  ///< empty: all
  int threads = 0;                  ///< 0: as many as cores
  bool quick = false;
  bool list = false;
  bool help = false;
};

/// Wrong usage, in one line.
class OptionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

extern const char kStabilityHelp[];

/// @throws OptionError.
StabilityOptions parseOptions(const std::vector<std::string>& arguments);

}  // namespace virtual_work_dynamics
