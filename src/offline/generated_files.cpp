#include "offline/generated_files.h"

#include <filesystem>
#include <iostream>
#include <system_error>

#include "base/checksum.h"
#include "base/output_file.h"
#include "base/printable.h"
#include "base/text_file.h"
#include "offline/task_inputs.h"
#include "virtual_work_dynamics/generated_code.h"

#ifndef VWD_VERSION
#define VWD_VERSION "(version not known)"
#endif

namespace virtual_work_dynamics {
namespace {

// Beyond so many operations a sample takes longer than by the library, whose code stays in the
// caches.
constexpr std::size_t kMostWorthwhile = 14000;
constexpr std::size_t kLongestInput = 1u << 30;

// What a file is, so that a reader of the code can tell whether it still is the same.
std::string originOf(const char* what, const std::string& path) {
  const std::filesystem::path file(path);
  std::string line = what + inQuotes(file.filename().string());
  std::error_code error;
  if (std::filesystem::is_regular_file(file, error)) {  // a pipe can be read only once
    const std::string text = readTextFile(path, kLongestInput);
    line += ", cksum " + std::to_string(posixChecksum(text)) + " " + std::to_string(text.size());
  }
  return line + ".";
}

// The name that a file gives to what is in it: of letters, digits and underscores.
std::string nameOf(const std::filesystem::path& file) {
  std::string name;
  for (const char c : file.stem().string()) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    const bool other = (c >= '0' && c <= '9') || c == '_';
    if (!letter && (!other || name.empty())) {
      throw UsageError("--generate: " + inQuotes(file.filename().string()) +
                       ": the functions are named after the file, which must begin with a letter "
                       "and have but letters, digits and underscores before its ending");
    }
    name += c;
  }
  return name;
}

void write(const std::string& path, const std::string& text) {
  OutputFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace

void requireSourceName(const Arguments& arguments) {
  const std::filesystem::path file(arguments.generate);
  const std::string ending = file.extension().string();
  if (ending != ".c" && ending != ".cc" && ending != ".cpp" && ending != ".cxx") {
    throw UsageError("--generate: " + inQuotes(arguments.generate) +
                     " does not end in .c, .cc, .cpp or .cxx");
  }
  nameOf(file);
}

std::string generatedHeader(const Arguments& arguments) {
  return std::filesystem::path(arguments.generate).replace_extension(".h").string();
}

void writeGeneratedFiles(const Arguments& arguments, const Mechanism& mechanism, const Scene& scene,
                         const Request& request) {
  const std::filesystem::path file(arguments.generate);
  GeneratedCodeOptions options;
  options.name = nameOf(file);
  options.origin = {
      std::string("Made by inverse_dynamics_offline --generate of virtual_work_dynamics ") +
          VWD_VERSION + "; not to be edited.",
      originOf("Description: ", arguments.inputs->description_file)};
  const std::string& scene_file = arguments.inputs->scene_file;
  if (!scene_file.empty()) options.origin.push_back(originOf("Scene: ", scene_file));
  const GeneratedCode code = generateCode(mechanism, scene, request, options);
  const std::string source = file.string(), header = generatedHeader(arguments);
  write(header, code.header);
  write(source, code.source);
  const std::size_t operations = code.multiplications + code.additions;
  std::cerr << "note: " << printable(source) << ", " << printable(header) << ": " << operations
            << " operations and " << code.sines_and_cosines << " sines and cosines a sample\n";
  if (operations > kMostWorthwhile) {
    std::cerr
        << "warning: of so many operations the code is too large for the caches: one sample at "
           "a time is computed faster by the library\n";
  }
}

}  // namespace virtual_work_dynamics
