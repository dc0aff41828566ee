#include "offline/output_file.h"

#include <signal.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr std::array<int, 3> kEndingSignals{SIGINT, SIGTERM, SIGHUP};

// The file that a signal handler may remove; null when there is none.
const char* volatile part_to_remove = nullptr;

extern "C" void removePartAndEnd(int signal_number) {
  if (part_to_remove != nullptr) unlink(part_to_remove);
  signal(signal_number, SIG_DFL);
  raise(signal_number);
}

// Holds back ending signals while a file is created or renamed and this is taken note of.
class SignalsHeld {
 public:
  SignalsHeld() {
    sigset_t set;
    sigemptyset(&set);
    for (const int number : kEndingSignals) sigaddset(&set, number);
    pthread_sigmask(SIG_BLOCK, &set, &previous_);
  }
  ~SignalsHeld() { pthread_sigmask(SIG_SETMASK, &previous_, nullptr); }
  SignalsHeld(const SignalsHeld&) = delete;
  SignalsHeld& operator=(const SignalsHeld&) = delete;

 private:
  sigset_t previous_;
};

void watchSignals() {
  for (const int number : kEndingSignals) {
    struct sigaction current;
    sigaction(number, nullptr, &current);
    if (current.sa_handler == SIG_IGN) continue;  // as nohup asks
    struct sigaction ending = {};
    ending.sa_handler = removePartAndEnd;
    sigaction(number, &ending, nullptr);
  }
}

}  // namespace

std::string partPath(const std::string& path) {
  return path + ".part";
}

OutputFile::OutputFile(const std::string& path) : path_(path) {
  if (path_.empty()) {
    path_ = "standard output";
    stream_ = stdout;
    return;
  }
  std::error_code no_matter;  // a problem shows when the file is opened
  const auto kind = std::filesystem::status(path_, no_matter).type();
  const bool may_replace =
      kind == std::filesystem::file_type::regular || kind == std::filesystem::file_type::not_found;
  if (may_replace) {
    // A symbolic link is kept; the file to which it points is replaced.
    if (std::filesystem::is_symlink(path_, no_matter)) {
      path_ = std::filesystem::weakly_canonical(path_, no_matter).string();
    }
    part_ = partPath(path_);
  }
  const SignalsHeld held;
  stream_ = std::fopen((may_replace ? part_ : path_).c_str(), "wb");
  if (stream_ == nullptr) throwCannotWrite(errno);
  if (may_replace) {
    part_to_remove = part_.c_str();
    watchSignals();
  }
}

OutputFile::~OutputFile() {
  if (stream_ != nullptr && stream_ != stdout) std::fclose(stream_);
  if (part_.empty()) return;
  const SignalsHeld held;
  part_to_remove = nullptr;
  unlink(part_.c_str());
}

void OutputFile::throwCannotWrite(int error) const {
  throw FileError(path_ + ": cannot be written: " + std::strerror(error));
}

void OutputFile::write(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stream_) != text.size()) throwCannotWrite(errno);
}

void OutputFile::commit() {
  std::FILE* const stream = stream_;
  stream_ = nullptr;
  if ((stream == stdout ? std::fflush(stream) : std::fclose(stream)) != 0) throwCannotWrite(errno);
  if (part_.empty()) return;
  const SignalsHeld held;
  if (std::rename(part_.c_str(), path_.c_str()) != 0) throwCannotWrite(errno);
  part_to_remove = nullptr;
  part_.clear();
}

}  // namespace virtual_work_dynamics
