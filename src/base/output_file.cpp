#include "base/output_file.h"

#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

/// Those that end a process unless it does something about them.
constexpr std::array<int, 17> kEndingSignals{SIGHUP,  SIGINT,  SIGQUIT, SIGILL,  SIGTRAP,  SIGABRT,
                                             SIGBUS,  SIGFPE,  SIGUSR1, SIGSEGV, SIGUSR2,  SIGPIPE,
                                             SIGALRM, SIGTERM, SIGXCPU, SIGXFSZ, SIGVTALRM};
constexpr std::size_t kLongestFileName = 255;
constexpr std::string_view kUnique = ".XXXXXX.part";

// The file that a signal handler may remove; null when there is none.
const char* volatile part_to_remove = nullptr;

/// The mode that a file at a path has, or that a new one gets.
mode_t modeOf(const std::string& path) {
  struct stat status;
  if (stat(path.c_str(), &status) == 0) return status.st_mode & 07777;
  const mode_t mask = umask(0);
  umask(mask);
  return 0666 & ~mask;
}

/// Creates a file of a name that no other process has, beside a path. @returns its descriptor, -1
/// on failure, with the reason in errno.
int createBeside(const std::string& path, std::string& part) {
  const std::filesystem::path whole(path);
  std::string name = whole.filename().string();
  name.resize(std::min(name.size(), kLongestFileName - kUnique.size()));
  part = (whole.parent_path() / (name + std::string(kUnique))).string();
  const int suffix = static_cast<int>(std::string_view(".part").size());
  const int descriptor = mkostemps(part.data(), suffix, O_CLOEXEC);
  if (descriptor < 0) return descriptor;
  // Some file systems have no modes; the file is written all the same.
  static_cast<void>(fchmod(descriptor, modeOf(path)));
  return descriptor;
}

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
  // A file that may not be written is not replaced either, though its folder would allow it.
  if (kind == std::filesystem::file_type::regular &&
      faccessat(AT_FDCWD, path_.c_str(), W_OK, AT_EACCESS) != 0) {
    throwCannotWrite(errno);
  }
  if (may_replace) {
    // A symbolic link is kept; the file to which it points is replaced.
    if (std::filesystem::is_symlink(path_, no_matter)) {
      path_ = std::filesystem::weakly_canonical(path_, no_matter).string();
    }
  }
  const SignalsHeld held;
  if (may_replace) {
    const int descriptor = createBeside(path_, part_);
    if (descriptor >= 0 && (stream_ = fdopen(descriptor, "wb")) == nullptr) unlink(part_.c_str());
  } else {
    stream_ = std::fopen(path_.c_str(), "wb");
  }
  if (stream_ == nullptr) {
    const int error = errno;
    part_.clear();
    throwCannotWrite(error);
  }
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

void OutputFile::rewrite(std::size_t position, const std::string& bytes) {
  if (fseeko(stream_, static_cast<off_t>(position), SEEK_SET) != 0) throwCannotWrite(errno);
  write(bytes);
  if (fseeko(stream_, 0, SEEK_END) != 0) throwCannotWrite(errno);
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
