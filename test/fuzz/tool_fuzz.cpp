// The offline tool on a folder with a description, a scene and a motion. An input has the words of
// the command line in its first line, then the three files, divided by lines "==== scene" and
// "==== motion".
#include <array>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "fuzz_folder.h"
#include "fuzz_target.h"
#include "offline/arguments.h"
#include "offline/offline.h"

using namespace virtual_work_dynamics;

namespace {

// Takes a text off `rest`, up to a divider, which is dropped.
std::string takeUpTo(const std::string& divider, std::string& rest) {
  const std::size_t end = rest.find(divider);
  const std::string text = rest.substr(0, end);
  rest.erase(0, end == std::string::npos ? end : end + divider.size());
  return text;
}

// Words that name other files or folders, or more threads than a fuzzer has room for, are left out.
std::vector<std::string> allowedWords(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word && words.size() < 16;) {
    bool allowed = true;
    for (const char* option :
         {"--urdf", "--scene", "--motion", "--output", "--report", "--threads"}) {
      allowed = allowed && word.rfind(option, 0) != 0;
    }
    if (allowed) words.push_back(word);
  }
  return words;
}

// What the tool says goes nowhere.
class Silence {
 public:
  Silence() : out_(std::cout.rdbuf(&nowhere_)), err_(std::cerr.rdbuf(&nowhere_)) {}
  ~Silence() {
    std::cout.rdbuf(out_);
    std::cerr.rdbuf(err_);
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  std::stringbuf nowhere_;
  std::streambuf *out_, *err_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const FuzzFolder folder;
  std::string rest = textOf(data, size);
  std::vector<std::string> words = allowedWords(takeUpTo("\n", rest));
  const std::string urdf = takeUpTo("==== scene\n", rest);
  const std::string scene = takeUpTo("==== motion\n", rest);
  const std::array<std::array<std::string, 3>, 3> files{{{"--urdf", "robot.urdf", urdf},
                                                         {"--scene", "scene.yaml", scene},
                                                         {"--motion", "motion.csv", rest}}};
  for (const auto& [option, name, text] : files) {
    if (text.empty()) continue;
    std::ofstream(folder.file(name.c_str()), std::ios::binary) << text;
    words.insert(words.end(), {option, folder.file(name.c_str())});
  }
  // A file would bring handlers of signals with it, which are the fuzzer's here.
  words.insert(words.end(), {"--output", "/dev/null"});
  const Silence silence;
  acceptOrRefuse([&] {
    const Arguments arguments = parseArguments(words);
    if (!arguments.help && !arguments.version) runOffline(arguments);
  });
  return 0;
}
