#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace virtual_work_dynamics {

struct WorkPrecisionOptions {
  std::string output;                ///< empty: no table as CSV
  std::vector<std::string> scenes;   ///< empty: all
  std::vector<std::string> methods;  ///< empty: all
  int rounds = 0;                    ///< 0: as many as usual
  bool quick = false;
  bool list = false;
  bool list_loops = false;
  bool help = false;
};

/// Wrong usage, in one line.
class OptionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

extern const char kWorkPrecisionHelp[];

/// @throws OptionError.
WorkPrecisionOptions parseOptions(const std::vector<std::string>& arguments);

}  // namespace virtual_work_dynamics
