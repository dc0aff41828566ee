#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

/// Ends the process with a finding of the fuzzer.
[[noreturn]] inline void failFuzz(const std::string& finding) {
  std::fprintf(stderr, "finding: %s\n", finding.c_str());
  std::abort();
}

/// Reads and uses an input. An Error, of one line, is the right answer to a bad one; everything
/// else that is thrown ends the process.
template <typename Use>
void acceptOrRefuse(Use use) {
  try {
    use();
  } catch (const Error& error) {
    const std::string text = error.what();
    if (text.empty()) failFuzz("a refusal without a word");
    if (text.find('\n') != std::string::npos) failFuzz("a refusal of several lines: " + text);
  }
}

inline std::string textOf(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace virtual_work_dynamics
