#include "command_line.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <iostream>

#include "offline/progress.h"

namespace virtual_work_dynamics {

Option flag(const std::string& name, bool& set) {
  return {name, false, [&set](const std::string&) { set = true; }};
}

Option text(const std::string& name, std::string& value) {
  return {name, true, [name, &value](const std::string& given) {
            if (!value.empty()) throw OptionError(name + " is given twice");
            value = given;
          }};
}

Option texts(const std::string& name, std::vector<std::string>& values) {
  return {name, true, [&values](const std::string& given) { values.push_back(given); }};
}

Option count(const std::string& name, int digits, int& value) {
  return {name, true, [name, digits, &value](const std::string& given) {
            const bool number = !given.empty() &&
                                given.size() <= static_cast<std::size_t>(digits) &&
                                given.find_first_not_of("0123456789") == std::string::npos;
            if (!number || std::stoi(given) < 1) {
              throw OptionError(name + ": '" + given + "' is not a number from 1 to " +
                                std::string(static_cast<std::size_t>(digits), '9'));
            }
            value = std::stoi(given);
          }};
}

void parseCommandLine(const std::vector<std::string>& arguments,
                      const std::vector<Option>& options) {
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& name = arguments[i];
    const auto known = std::find_if(options.begin(), options.end(),
                                    [&](const Option& option) { return option.name == name; });
    if (known == options.end()) throw OptionError("unknown option '" + name + "'");
    if (known->has_value && i + 1 == arguments.size()) throw OptionError(name + " needs a value");
    known->take(known->has_value ? arguments[++i] : "");
  }
}

namespace {

ProgressLine& programsLine() {
  static ProgressLine line(std::cerr, ProgressLine::whereIs(STDERR_FILENO));
  return line;
}

}  // namespace

void showProgress(const std::string& text, std::size_t done, std::size_t total) {
  static const ProgressLine::Clock::time_point start = ProgressLine::Clock::now();
  const std::chrono::duration<double> seconds = ProgressLine::Clock::now() - start;
  programsLine().show(text + partDone(done, total, seconds.count()));
}

void clearProgress() {
  programsLine().clear();
}

int runProgram(const std::string& name, const char* help, int argc, char** argv,
               const std::vector<Option>& options, const std::function<int()>& run) {
  try {
    bool wants_help = false;
    std::vector<Option> all = options;
    all.push_back(flag("--help", wants_help));
    all.push_back(flag("-h", wants_help));
    parseCommandLine({argv + 1, argv + argc}, all);
    if (wants_help) {
      std::printf("%s", help);
      return 0;
    }
    return run();
  } catch (const OptionError& error) {
    std::fprintf(stderr, "%s: %s; --help names all options\n", name.c_str(), error.what());
    return 2;
  } catch (const std::exception& error) {
    clearProgress();
    std::fprintf(stderr, "%s: %s\n", name.c_str(), error.what());
    return 1;
  }
}

}  // namespace virtual_work_dynamics
