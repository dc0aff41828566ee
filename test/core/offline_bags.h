#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "offline_tool.h"

namespace virtual_work_dynamics {

// What bags/make_bags.py says of the bags beside it, which rosbag wrote.
inline constexpr int kMessages = 40;
inline constexpr std::int64_t kStartSeconds = 1600000000;
inline constexpr int kStartMilliseconds = 123;
inline constexpr char kStartRest[] = "456789";  // ns

inline double positionOf(int joint, int message) {
  const double time = message / 100.0;
  return (joint + 1) * time * time;
}

inline double velocityOf(int joint, int message) {
  return (joint + 1) * 2 * (message / 100.0);
}

inline std::string stampOf(int message) {
  const int milliseconds = kStartMilliseconds + 10 * message;
  const std::string rest = std::to_string(1000 + milliseconds % 1000).substr(1);
  return std::to_string(kStartSeconds + milliseconds / 1000) + "." + rest + kStartRest;
}

inline std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// Lines of a text that contain a word.
inline int countLines(const std::string& text, const std::string& word) {
  int count = 0;
  for (const std::string& line : linesOf(text)) count += line.find(word) != std::string::npos;
  return count;
}

// Splits a line of numbers without quotes.
inline std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

/// With a pendulum, and the bags of the folder beside the tests.
class OfflineBags : public OfflineTool {
 protected:
  void SetUp() override {
    OfflineTool::SetUp();
    write("p.urdf", kPendulum);
    // A static scene hands positions on as they are.
    write("static.yaml", "motion: static\nreactions: none\n");
  }

  static std::string bag(const std::string& name) {
    return std::string(kSourceFolder) + "/test/core/bags/" + name;
  }
  std::string copy(const std::string& name, const std::string& content) const {
    return write(name, content);
  }
  Run positions(const std::string& motion) const {
    return run("--urdf p.urdf --scene static.yaml --no-efforts --positions --motion " + motion);
  }
};

// The rows of a table of positions() are those of these messages of the joint at this place.
inline void expectRows(const std::string& csv, const std::vector<int>& messages, int joint = 0) {
  const std::vector<std::string> lines = linesOf(csv);
  ASSERT_EQ(lines.size(), messages.size() + 1);
  EXPECT_EQ(lines[0].rfind("time,stamp,position.hinge", 0), 0U) << lines[0];
  for (std::size_t row = 0; row < messages.size(); ++row) {
    const std::vector<std::string> cells = cellsOf(lines[row + 1]);
    ASSERT_GE(cells.size(), 3U);
    const double time = (messages[row] - messages[0]) / 100.0;
    EXPECT_NEAR(std::stod(cells[0]), time, 1e-15);
    EXPECT_EQ(cells[1], stampOf(messages[row]));
    EXPECT_NEAR(std::stod(cells[2]), positionOf(joint, messages[row]), 1e-15);
  }
}

inline std::vector<int> allMessages() {
  std::vector<int> messages;
  for (int i = 0; i < kMessages; ++i) messages.push_back(i);
  return messages;
}

}  // namespace virtual_work_dynamics
