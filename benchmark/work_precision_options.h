#pragma once

#include <string>
#include <vector>

#include "command_line.h"

namespace virtual_work_dynamics {

struct WorkPrecisionOptions {
  std::string output;                ///< empty: no table as CSV
  std::vector<std::string> scenes;   ///< empty: all
  std::vector<std::string> methods;  ///< empty: all
  int rounds = 0;                    ///< 0: as many as usual
  bool quick = false;
  std::string description;  ///< scene whose description is printed; empty: none
  bool list = false;
  bool list_loops = false;
};

extern const char kWorkPrecisionHelp[];

/// The options of the command line that fill `options`.
std::vector<Option> commandLine(WorkPrecisionOptions& options);

}  // namespace virtual_work_dynamics
