#pragma once

#include <string>
#include <vector>

#include "command_line.h"

namespace virtual_work_dynamics {

struct StabilityOptions {
  std::string output;               ///< empty: no table as CSV
  std::string details;              ///< empty: no table of what is measured for double alone
  std::vector<std::string> scenes;  ///< empty: all
  int threads = 0;                  ///< 0: as many as cores
  bool quick = false;
  bool list = false;
};

extern const char kStabilityHelp[];

/// The options of the command line that fill `options`.
std::vector<Option> commandLine(StabilityOptions& options);

}  // namespace virtual_work_dynamics
