#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

#include "fuzz_target.h"

namespace virtual_work_dynamics {

/// A folder that is removed when the process ends well.
class FuzzFolder {
 public:
  FuzzFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "vwd_fuzz_XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) failFuzz("no folder can be made");
    path_ = pattern;
  }
  ~FuzzFolder() {
    std::error_code no_matter;
    std::filesystem::remove_all(path_, no_matter);
  }
  std::string file(const char* name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

}  // namespace virtual_work_dynamics
