#include "contenders/built_library.h"

#include <dlfcn.h>
#include <stdlib.h>

#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

// A folder with a name of its own, which is removed with all that is in it.
class NewFolder {
 public:
  NewFolder() : path_(std::filesystem::temp_directory_path() / "virtual_work_XXXXXX") {
    if (mkdtemp(path_.data()) == nullptr) throw Error("no folder can be made for generated code");
  }
  ~NewFolder() {
    std::error_code no_matter;
    std::filesystem::remove_all(path_, no_matter);
  }
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

  const std::string& path() const { return path_; }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream file(path_ + "/" + name, std::ios::binary);
    if (!(file << text).flush()) throw Error(path_ + "/" + name + ": cannot be written");
  }

 private:
  std::string path_;
};

bool hasVectorLengths() {
#if defined(__x86_64__) || defined(__i386__)
  return __builtin_cpu_supports("avx512vl") != 0;
#else
  return false;
#endif
}

std::string optionsFor(const std::string& name, InstructionSet set) {
  std::string options = "-std=c99 -O2 -w -fPIC -shared -D";
  for (const char c : name) {
    options += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  options += set == InstructionSet::kBaseline ? "_FUSED=0" : "_FUSED=1 -mavx2 -mfma";
  if (set == InstructionSet::kAvx512) {
    options += " -mavx512f -mavx512dq";
    if (hasVectorLengths()) options += " -mavx512vl";
  }
  return options;
}

}  // namespace

BuiltLibrary::BuiltLibrary(const std::string& name, const GeneratedCode& code,
                           InstructionSet instruction_set) {
  const NewFolder folder;
  folder.write(name + ".h", code.header);
  folder.write(name + ".c", code.source);
  const char* const chosen = std::getenv("CC");
  const std::string compiler = chosen && *chosen ? chosen : "cc";
  const std::string command = "cd '" + folder.path() + "' && " + compiler + " " +
                              optionsFor(name, instruction_set) + " " + name + ".c -o code.so -lm";
  if (std::system(command.c_str()) != 0) throw Error("generated code: failed: " + command);
  library_ = dlopen((folder.path() + "/code.so").c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library_ == nullptr) throw Error(std::string("generated code: ") + dlerror());
}

BuiltLibrary::~BuiltLibrary() {
  dlclose(library_);
}

void* BuiltLibrary::function(const std::string& name) const {
  void* const address = dlsym(library_, name.c_str());
  if (address == nullptr) throw Error("generated code has no function " + name);
  return address;
}

}  // namespace virtual_work_dynamics
