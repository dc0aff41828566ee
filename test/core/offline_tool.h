#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "tested_build.h"

namespace virtual_work_dynamics {

/// Runs the built offline tool as a user would, in a folder of its own that is removed afterwards.
/// Name of a file in a folder that an output is being written to, empty: there is none.
inline std::string partialFile(const std::string& folder) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const std::string end = ".part";
    if (name.size() > end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0 &&
        name.rfind("r.csv.", 0) == 0)
      return name;
  }
  return "";
}

class OfflineTool : public testing::Test {
 protected:
  struct Run {
    int exit_code = -1;
    std::string out;
    std::string err;
  };

  OfflineTool() {
    std::string pattern = testing::TempDir() + "offline_tool_XXXXXX";
    folder_ = mkdtemp(pattern.data()) == nullptr ? "" : pattern;
  }
  ~OfflineTool() override { std::filesystem::remove_all(folder_); }

  void SetUp() override { ASSERT_FALSE(folder_.empty()); }

  const std::string& folder() const { return folder_; }
  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  bool exists(const std::string& name) const { return std::filesystem::exists(path(name)); }

  std::string write(const std::string& name, const std::string& content) const {
    std::ofstream(path(name), std::ios::binary) << content;
    return path(name);
  }

  static std::string readFile(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

  /// Runs the tool in the folder; `arguments` and the words `before` the tool are shell text.
  Run run(const std::string& arguments, const std::string& before = "") const {
    const std::string command = "cd '" + folder_ + "' && { " + before + " '" + kOfflineTool + "' " +
                                arguments + "; } >'" + folder_ + ".out' 2>'" + folder_ + ".err'";
    const int status = std::system(command.c_str());
    Run result;
    result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    result.out = readFile(folder_ + ".out");
    result.err = readFile(folder_ + ".err");
    std::filesystem::remove(folder_ + ".out");
    std::filesystem::remove(folder_ + ".err");
    return result;
  }

 private:
  std::string folder_;
};

/// A CSV of numbers; an empty cell is NaN.
struct NumberTable {
  std::vector<std::string> header;
  std::vector<std::vector<double>> rows;

  /// The column of a name; -1 when there is none.
  int column(const std::string& name) const {
    const auto found = std::find(header.begin(), header.end(), name);
    return found == header.end() ? -1 : static_cast<int>(found - header.begin());
  }
};

inline NumberTable parseTable(const std::string& csv) {
  NumberTable table;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty() && line[0] == '#') continue;
    std::vector<std::string> cells;
    std::istringstream stream(line + ",");
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    if (table.header.empty()) {
      table.header = cells;
      continue;
    }
    table.rows.emplace_back();
    for (const std::string& cell : cells) {
      table.rows.back().push_back(std::strtod(cell.empty() ? "nan" : cell.c_str(), nullptr));
    }
  }
  return table;
}

/// A bob on a hinge about y: 2 kg, 0.5 m below the hinge, which is 1 m above the root link.
constexpr char kPendulum[] = R"(<robot name="pendulum">
  <link name="stand"><inertial><mass value="3"/>
    <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="bob"><inertial><origin xyz="0 0 -0.5"/><mass value="2"/>
    <inertia ixx="0.03" iyy="0.03" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="hinge" type="continuous"><parent link="stand"/><child link="bob"/>
    <origin xyz="0 0 1"/><axis xyz="0 1 0"/></joint>
</robot>)";

/// The end of the header with --certificates.
constexpr char kCertificateColumns[] =
    ",certificate.power,certificate.ground_force,certificate.ground_moment";

/// Removes the columns of --certificates from a table.
inline std::string withoutCertificates(const std::string& csv) {
  std::istringstream lines(csv);
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    for (int i = 0; i < 3; ++i) line.erase(line.rfind(','));
    text += line + "\n";
  }
  return text;
}

/// A slide, a hinge that another one mimics, and a fixed flange with a needle-thin tool on it.
constexpr char kCrane[] = R"(<robot name="crane">
  <link name="base"/>
  <link name="sledge"><inertial><mass value="4"/>
    <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="boom"><inertial><origin xyz="0.4 0 0"/><mass value="1.5"/>
    <inertia ixx="0.01" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="jib"><inertial><origin xyz="0.2 0 0"/><mass value="0.5"/>
    <inertia ixx="0.01" iyy="0.05" izz="0.05" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="tool"><inertial><mass value="0.25"/>
    <inertia ixx="0" iyy="0" izz="3e-06" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="slide" type="prismatic"><parent link="base"/><child link="sledge"/>
    <axis xyz="0 0 1"/><limit lower="0" upper="1" effort="1" velocity="1"/></joint>
  <joint name="shoulder" type="revolute"><parent link="sledge"/><child link="boom"/>
    <axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="elbow" type="revolute"><parent link="boom"/><child link="jib"/>
    <origin xyz="0.8 0 0"/><axis xyz="0 1 0"/><mimic joint="shoulder" multiplier="-2" offset="0.1"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="flange" type="fixed"><parent link="jib"/><child link="tool"/>
    <origin xyz="0.4 0 0"/></joint>
</robot>)";

}  // namespace virtual_work_dynamics
