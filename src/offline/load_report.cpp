#include "offline/load_report.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <system_error>
#include <vector>

#include "base/output_file.h"
#include "base/printable.h"
#include "offline/mechanism_json.h"
#include "virtual_work_dynamics/error.h"

extern char** environ;

namespace virtual_work_dynamics {
namespace {

constexpr char kProgram[] = "load_report.py";

// Beside this program, as it is built and as catkin installs it, or in the folder of data of the
// core alone.
std::filesystem::path reportProgram() {
  std::error_code unknown;
  const std::filesystem::path here =
      std::filesystem::read_symlink("/proc/self/exe", unknown).parent_path();
  const std::filesystem::path data = here.parent_path() / "share" / "virtual_work_dynamics";
  for (const std::filesystem::path& folder : {here, data}) {
    if (std::filesystem::exists(folder / kProgram, unknown)) return folder / kProgram;
  }
  throw FileError(std::string("--report: ") + kProgram + " is not beside this program in " +
                  here.string());
}

// Runs a program, whose output is that of this one. @returns its exit status.
int runProgram(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  pid_t process = 0;
  const int error =
      posix_spawn(&process, words[0].c_str(), nullptr, nullptr, arguments.data(), environ);
  if (error != 0) {
    throw FileError("--report: " + words[0] + " cannot be run: " + std::strerror(error));
  }
  int status = 0;
  while (waitpid(process, &status, 0) < 0) {
    if (errno != EINTR) throw FileError("--report: " + words[0] + ": " + std::strerror(errno));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

void makeReportFolder(const Arguments& arguments) {
  std::error_code error;
  std::filesystem::create_directories(arguments.report, error);
  if (error) {
    throw FileError("--report: " + arguments.report + ": cannot be made: " + error.message());
  }
  reportProgram();
}

void makeLoadReport(const Arguments& arguments, const std::string& mechanism) {
  std::cout << std::flush;
  std::vector<std::string> words{reportProgram().string(), "--output", arguments.report};
  if (!arguments.toNpz()) {
    const std::string path = arguments.report + "/" + kMechanismFile;
    OutputFile file(path);
    file.write(mechanism);
    file.commit();
    words.insert(words.end(), {"--mechanism", path});
  }
  words.push_back(arguments.output);
  const int status = runProgram(words);
  if (status != 0) {
    throw FileError("--report: " + std::string(kProgram) + " ended with status " +
                    std::to_string(status) + "; the results are in " + arguments.output);
  }
}

}  // namespace virtual_work_dynamics
