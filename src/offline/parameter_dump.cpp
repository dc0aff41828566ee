#include "offline/parameter_dump.h"

#include <algorithm>
#include <cstddef>

#include "base/printable.h"
#include "base/text_file.h"
#include "scene/yaml_document.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr std::size_t kLongestDump = std::size_t{1} << 28;  // bytes

void collect(const YAML::Node& map, const std::string& space, const std::string& word,
             std::vector<std::string>& names) {
  for (const auto& entry : map) {
    if (!entry.first.IsScalar()) continue;
    const std::string name = space + "/" + entry.first.Scalar();
    if (entry.first.Scalar() == word) {
      names.push_back(name);
    } else if (entry.second.IsMap()) {
      collect(entry.second, name, word, names);
    }
  }
}

}  // namespace

std::vector<std::string> searchedNames(const std::string& space, const std::string& name) {
  std::vector<std::string> names;
  for (std::string above = space; !above.empty(); above.erase(above.rfind('/'))) {
    names.push_back(above + "/" + name);
  }
  names.push_back("/" + name);
  return names;
}

ParameterDump::ParameterDump(const std::string& path) {
  try {
    root_ = readYamlDocument(readTextFile(path, kLongestDump));
  } catch (const SceneError& error) {
    throw FileError(path + ": " + error.what());
  } catch (const YAML::Exception& error) {
    throw FileError(path + ": is not valid YAML: " + printable(error.what()));
  }
  if (!root_.IsMap()) {
    throw FileError(path + ": is no map of parameters, as 'rosparam dump' writes it");
  }
}

std::optional<YAML::Node> ParameterDump::find(const std::string& name) const {
  YAML::Node value = root_;
  for (std::size_t begin = 1; begin <= name.size();) {
    const std::size_t end = std::min(name.find('/', begin), name.size());
    if (!value.IsMap()) return std::nullopt;
    const YAML::Node& map = value;  // of which [] adds nothing
    const YAML::Node member = map[name.substr(begin, end - begin)];
    if (!member.IsDefined()) return std::nullopt;
    value.reset(member);
    begin = end + 1;
  }
  return value;
}

std::string ParameterDump::firstOf(const std::vector<std::string>& names) const {
  for (const std::string& name : names) {
    if (find(name)) return name;
  }
  return "";
}

std::vector<std::string> ParameterDump::endingIn(const std::string& word) const {
  std::vector<std::string> names;
  collect(root_, "", word, names);
  return names;
}

}  // namespace virtual_work_dynamics
