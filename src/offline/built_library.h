#pragma once

#include <string>
#include <vector>

#include "virtual_work_dynamics/instruction_set.h"

namespace virtual_work_dynamics {

/// Options with which generated code has the bits of the library's build for these instructions.
/// @param name of the code, with which its names begin
std::vector<std::string> optionsFor(InstructionSet instruction_set, const std::string& name);

/// A shared library that a C compiler of this machine makes of a source. Everything it takes is in
/// a folder that nobody else can read and that is removed before the constructor returns, also when
/// a signal ends the process meanwhile.
class BuiltLibrary {
 public:
  /// @param header, source written as `name`.h and `name`.c
  /// @param options of the compiler, cc, gcc or clang, whichever is found first
  /// @throws Error, one line that says why there is no library.
  BuiltLibrary(const std::string& name, const std::string& header, const std::string& source,
               const std::vector<std::string>& options);
  ~BuiltLibrary();
  BuiltLibrary(const BuiltLibrary&) = delete;
  BuiltLibrary& operator=(const BuiltLibrary&) = delete;

  /// The address of a function. @throws Error when there is none of this name.
  void* function(const std::string& name) const;

 private:
  void* library_ = nullptr;
};

}  // namespace virtual_work_dynamics
