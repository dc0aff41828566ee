#include "offline/built_library.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "base/printable.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

using Words = std::vector<std::string>;

constexpr const char* kCompilers[] = {"cc", "gcc", "clang"};
constexpr std::chrono::minutes kLongest{2};
constexpr long kStepNs = 10'000'000;  // between two looks at a compiler

std::string reasonOf(int error) {
  return std::generic_category().message(error);
}

// A folder of mode 0700 with a name of its own, which is removed with all that is in it.
class PrivateFolder {
 public:
  PrivateFolder() {
    const char* const temporary = std::getenv("TMPDIR");
    const std::string where = temporary && *temporary ? temporary : "/tmp";
    path_ = where + "/virtual_work_XXXXXX";
    if (mkdtemp(path_.data()) == nullptr) {
      throw Error("no folder can be made in " + inQuotes(where) + ": " + reasonOf(errno));
    }
  }
  ~PrivateFolder() {
    std::error_code no_matter;
    std::filesystem::remove_all(path_, no_matter);
  }
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  std::string file(const std::string& name) const { return path_ + "/" + name; }
  const std::string& path() const { return path_; }

  void write(const std::string& name, const std::string& text) const {
    const std::string path = file(name);
    const int descriptor = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    std::size_t done = 0;
    int error = descriptor < 0 ? errno : 0;
    while (error == 0 && done < text.size()) {
      const ssize_t count = ::write(descriptor, text.data() + done, text.size() - done);
      if (count > 0) done += static_cast<std::size_t>(count);
      if (count < 0 && errno != EINTR) error = errno;
    }
    if (descriptor >= 0) close(descriptor);
    if (error != 0) throw Error(inQuotes(path) + " cannot be written: " + reasonOf(error));
  }

 private:
  std::string path_;
};

// Holds back the signals that end a process, so that what is to be removed is. Those that the
// process ignores, as under nohup, stay ignored.
class EndingHeld {
 public:
  EndingHeld() {
    sigemptyset(&set_);
    for (const int number : {SIGHUP, SIGINT, SIGQUIT, SIGTERM}) {
      if (!isIgnored(number)) sigaddset(&set_, number);
    }
    pthread_sigmask(SIG_BLOCK, &set_, &previous_);
  }
  ~EndingHeld() {
    if (received_ > 0) raise(received_);
    pthread_sigmask(SIG_SETMASK, &previous_, nullptr);
  }
  EndingHeld(const EndingHeld&) = delete;
  EndingHeld& operator=(const EndingHeld&) = delete;

  /// Waits a moment; returns whether such a signal has come.
  bool wait() {
    const timespec step = {0, kStepNs};
    const int number = sigtimedwait(&set_, nullptr, &step);
    if (number > 0) received_ = number;
    return number > 0;
  }
  const sigset_t& previous() const { return previous_; }

 private:
  static bool isIgnored(int number) {
    struct sigaction action = {};
    return sigaction(number, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
  }

  sigset_t set_, previous_;
  int received_ = 0;
};

std::vector<char*> pointersTo(Words& words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

// The environment with another folder for temporary files.
Words environmentWith(const std::string& folder) {
  Words all;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    if (std::strncmp(*entry, "TMPDIR=", 7) != 0) all.emplace_back(*entry);
  }
  all.push_back("TMPDIR=" + folder);
  return all;
}

// Starts a program found on the PATH, without a shell, in a process group of its own and with
// nothing to read or write. @returns an error number.
int start(Words words, Words environment, const sigset_t& mask, pid_t& process) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
  posix_spawnattr_setsigmask(&attributes, &mask);
  const int error = posix_spawnp(&process, words[0].c_str(), &files, &attributes,
                                 pointersTo(words).data(), pointersTo(environment).data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  return error;
}

// Waits for a compiler to end, and ends it when a signal or too much time demands it.
void await(pid_t process, const std::string& compiler, EndingHeld& signals) {
  const auto latest = std::chrono::steady_clock::now() + kLongest;
  int status = 0;
  pid_t ended = 0;
  while ((ended = waitpid(process, &status, WNOHANG)) == 0 || (ended < 0 && errno == EINTR)) {
    const bool signalled = signals.wait();
    if (!signalled && std::chrono::steady_clock::now() < latest) continue;
    kill(-process, SIGKILL);
    waitpid(process, &status, 0);
    throw Error(compiler + (signalled ? " was interrupted" : " takes more than two minutes"));
  }
  if (ended < 0) throw Error("how " + compiler + " ended is not known: " + reasonOf(errno));
  if (WIFSIGNALED(status)) {
    throw Error(compiler + " was ended by signal " + std::to_string(WTERMSIG(status)));
  }
  if (WEXITSTATUS(status) != 0) {
    throw Error(compiler + " fails with exit status " + std::to_string(WEXITSTATUS(status)));
  }
}

void compile(const Words& options, const std::string& folder, EndingHeld& signals) {
  int error = 0;
  for (const char* const compiler : kCompilers) {
    Words words = {compiler};
    words.insert(words.end(), options.begin(), options.end());
    pid_t process = 0;
    error = start(words, environmentWith(folder), signals.previous(), process);
    if (error == 0) return await(process, compiler, signals);
    if (error != ENOENT) throw Error(std::string(compiler) + " cannot run: " + reasonOf(error));
  }
  throw Error("there is no C compiler (cc, gcc or clang)");
}

bool hasVectorLengths() {
#if defined(__x86_64__) || defined(__i386__)
  return __builtin_cpu_supports("avx512vl") != 0;
#else
  return false;
#endif
}

}  // namespace

std::vector<std::string> optionsFor(InstructionSet instruction_set, const std::string& name) {
  std::string fused = name + "_FUSED=";
  for (char& c : fused) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  Words options = {"-std=c99", "-O2", "-w", "-D" + fused + "1"};
  if (instruction_set == InstructionSet::kBaseline) {
    options.back().back() = '0';
    return options;
  }
  options.insert(options.end(), {"-mavx2", "-mfma"});
  if (instruction_set == InstructionSet::kAvx512) {
    options.insert(options.end(), {"-mavx512f", "-mavx512dq"});
    if (hasVectorLengths()) options.emplace_back("-mavx512vl");
  }
  return options;
}

BuiltLibrary::BuiltLibrary(const std::string& name, const std::string& header,
                           const std::string& source, const std::vector<std::string>& options) {
  EndingHeld signals;
  const PrivateFolder folder;
  folder.write(name + ".h", header);
  folder.write(name + ".c", source);
  const std::string library = folder.file(name + ".so");
  Words all = options;
  for (const char* const option : {"-fPIC", "-shared", "-o"}) all.emplace_back(option);
  all.insert(all.end(), {library, folder.file(name + ".c"), "-lm"});
  compile(all, folder.path(), signals);
  library_ = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library_ == nullptr)
    throw Error("what was compiled cannot be loaded: " + printable(dlerror()));
}

BuiltLibrary::~BuiltLibrary() {
  dlclose(library_);
}

void* BuiltLibrary::function(const std::string& name) const {
  void* const address = dlsym(library_, name.c_str());
  if (address == nullptr) throw Error("what was compiled has no function " + name);
  return address;
}

}  // namespace virtual_work_dynamics
