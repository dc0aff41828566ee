#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace virtual_work_dynamics {

/// The command line is wrong; what() says why in one line.
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
/// An option that may be repeated.
Option texts(const std::string& name, std::vector<std::string>& values);
/// An option whose value is an integer from 1 to the largest one with this many digits.
Option count(const std::string& name, int digits, int& value);

/// Takes the options in the order in which they are given. @throws OptionError for a wrong one.
void parseCommandLine(const std::vector<std::string>& arguments,
                      const std::vector<Option>& options);

/// Shows what the program is at, how far it is and how long it will take, on a ProgressLine of
/// standard error. @param done of the `total` parts of all its work.
void showProgress(const std::string& text, std::size_t done, std::size_t total);
/// Wipes that line out, before something else is printed.
void clearProgress();

/// Parses the command line, including --help and -h, and runs the program.
/// @param run the program, called after the options were taken.
/// @returns the exit status: that of `run`, 2 for wrong usage, or 1 for any other exception.
int runProgram(const std::string& name, const char* help, int argc, char** argv,
               const std::vector<Option>& options, const std::function<int()>& run);

}  // namespace virtual_work_dynamics
