#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace virtual_work_dynamics {

/// Wrong usage, in one line.
class OptionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An option of a program and what it does with its value.
struct Option {
  std::string name;
  bool has_value;
  std::function<void(const std::string&)> take;
};
Option flag(const std::string& name, bool& set);
Option text(const std::string& name, std::string& value);
/// May be repeated.
Option texts(const std::string& name, std::vector<std::string>& values);
/// An integer from 1 to so many nines.
Option count(const std::string& name, int digits, int& value);

/// Takes the options in the order in which they are given.
/// @throws OptionError
void parseCommandLine(const std::vector<std::string>& arguments,
                      const std::vector<Option>& options);

/// One line that is written over, on a terminal only.
void showProgress(const std::string& text);

/// Parses the command line, with --help and -h, and runs the program. Returns its exit status: 2
/// for wrong usage, 1 for whatever it throws else.
/// @param run after the options were taken
int runProgram(const std::string& name, const char* help, int argc, char** argv,
               const std::vector<Option>& options, const std::function<int()>& run);

}  // namespace virtual_work_dynamics
