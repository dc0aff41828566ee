#include "scene/drive_reader.h"

#include <algorithm>
#include <vector>

#include "scene/yaml_values.h"

namespace virtual_work_dynamics {

namespace {

const Names kDriveKeys = {"name",       "law",          "offset",          "amplitude",
                          "period",     "phase",        "start_frequency", "end_frequency",
                          "duration",   "coefficients", "times",           "positions",
                          "velocities", "accelerations"};

// In the order of DriveFunction.
const Names kFunctions = {"polynomial", "cosine", "sine", "sine_sweep", "minimum_jerk", "table"};

// What a function needs, and what it may have besides, in the order of DriveFunction.
struct DriveUse {
  Names needs, takes;
};
const std::vector<DriveUse> kDriveUses = {
    {{"coefficients"}, {"times"}},
    {{"amplitude", "period"}, {}},
    {{"amplitude", "period"}, {"phase"}},
    {{"amplitude", "start_frequency", "end_frequency", "duration"}, {}},
    {{"times", "positions"}, {}},
    {{"times", "positions"}, {"velocities", "accelerations"}}};

std::vector<double> readNumbers(const YAML::Node& node, const std::string& key) {
  if (!node.IsSequence() || node.size() == 0) failAt(key, "expected a list of numbers");
  return readList(node, key, readNumber);
}

// Of one polynomial, or a list for each piece.
std::vector<std::vector<double>> readCoefficients(const YAML::Node& node, const std::string& key) {
  if (node.IsSequence() && node.size() > 0 && node[0].IsSequence()) {
    return readList(node, key, readNumbers);
  }
  return {readNumbers(node, key)};
}

void checkUse(const DriveLaw& law, const Names& given, const std::string& where) {
  const auto index = static_cast<std::size_t>(law.function);
  const DriveUse& use = kDriveUses[index];
  for (const std::string& key : use.needs) {
    if (!contains(given, key)) failAt(where, key + " is missing");
  }
  for (const std::string& key : given) {
    if (contains({"name", "law", "offset"}, key)) continue;
    if (contains(use.needs, key) || contains(use.takes, key)) continue;
    failAt(where + "." + key, "the law " + kFunctions[index] + " has none");
  }
}

}  // namespace

DriveLaw readDrive(const YAML::Node& node, const std::string& where) {
  DriveLaw law;
  Names given;
  readMap(node, where, kDriveKeys, [&](const auto& key, const auto& value, const auto& path) {
    given.push_back(key);
    if (key == "name") law.name = scalarText(value, path, "the name of a joint or closure");
    if (key == "law") law.function = static_cast<DriveFunction>(readWord(value, path, kFunctions));
    if (key == "offset") law.offset = readNumber(value, path);
    if (key == "amplitude") law.amplitude = readNumber(value, path);
    if (key == "period") law.period = readNumber(value, path);
    if (key == "phase") law.phase = readNumber(value, path);
    if (key == "start_frequency") law.start_frequency = readNumber(value, path);
    if (key == "end_frequency") law.end_frequency = readNumber(value, path);
    if (key == "duration") law.duration = readNumber(value, path);
    if (key == "coefficients") law.coefficients = readCoefficients(value, path);
    if (key == "times") law.times = readNumbers(value, path);
    if (key == "positions") law.positions = readNumbers(value, path);
    if (key == "velocities") law.velocities = readNumbers(value, path);
    if (key == "accelerations") law.accelerations = readNumbers(value, path);
  });
  for (const char* key : {"name", "law"}) {
    if (!contains(given, key)) failAt(where, std::string(key) + " is missing");
  }
  checkUse(law, given, where);
  return law;
}

}  // namespace virtual_work_dynamics
