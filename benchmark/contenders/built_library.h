#pragma once

#include <string>

#include "virtual_work_dynamics/generated_code.h"
#include "virtual_work_dynamics/instruction_set.h"

namespace virtual_work_dynamics {

/// Generated code as a shared library, compiled by the C compiler that the environment variable CC
/// names, or by cc, with the bits of the library's build for these instructions.
class BuiltLibrary {
 public:
  /// @param name of the code, with which its names begin
  /// @throws Error when it cannot be compiled or loaded.
  BuiltLibrary(const std::string& name, const GeneratedCode& code, InstructionSet instruction_set);
  ~BuiltLibrary();
  BuiltLibrary(const BuiltLibrary&) = delete;
  BuiltLibrary& operator=(const BuiltLibrary&) = delete;

  /// The address of a function. @throws Error when there is none of this name.
  void* function(const std::string& name) const;

 private:
  void* library_ = nullptr;
};

}  // namespace virtual_work_dynamics
