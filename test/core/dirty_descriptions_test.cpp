#include "dirty_descriptions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <map>
#include <string>

#include "offline_tool.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

constexpr unsigned kDescriptions = 600;
constexpr unsigned kEvery = 20;        // of them, the tool itself is given one
constexpr std::size_t kLongest = 600;  // bytes of a line, which still is one on a screen

// Whether a text is one line of what a terminal shows: no control characters, in UTF-8.
bool isOneLine(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (c < 0x20 || c == 0x7f) return false;
    if (c < 0x80) continue;
    const std::size_t more = c >= 0xf0 ? 3 : c >= 0xe0 ? 2 : 1;
    if (c < 0xc2 || i + more >= text.size() + 1) return false;
    for (std::size_t j = 1; j <= more; ++j) {
      if ((static_cast<unsigned char>(text[i + j]) & 0xc0) != 0x80) return false;
    }
    i += more;
  }
  return !text.empty() && text.size() <= kLongest;
}

std::string named(unsigned seed, const DirtyDescription& dirty) {
  std::string text = "seed " + std::to_string(seed) + ":";
  for (const std::string& fault : dirty.faults) text += " [" + fault + "]";
  return text;
}

TEST(DirtyDescriptions, EachIsReadOrRefusedInOneLine) {
  int read = 0, refused = 0, warned = 0;
  double slowest = 0;
  std::string slowest_name;
  for (unsigned seed = 0; seed < kDescriptions; ++seed) {
    const DirtyDescription dirty = dirtyDescription(seed);
    SCOPED_TRACE(named(seed, dirty));
    const auto start = std::chrono::steady_clock::now();
    try {
      const Mechanism mechanism = readUrdf(dirty.urdf);
      EXPECT_NE(dirty.verdict, Verdict::kRefuse);
      ++read;
      warned += !mechanism.doubts().empty();
      for (const Doubt& doubt : mechanism.doubts())
        EXPECT_TRUE(isOneLine(doubt.text)) << doubt.text;
    } catch (const UrdfError& error) {
      EXPECT_NE(dirty.verdict, Verdict::kAccept) << error.what();
      EXPECT_TRUE(isOneLine(error.what())) << error.what();
      ++refused;
    }
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    if (time.count() > slowest) slowest_name = named(seed, dirty);
    slowest = std::max(slowest, time.count());
  }
  EXPECT_EQ(read + refused, static_cast<int>(kDescriptions));
  RecordProperty("read", read);
  RecordProperty("read_with_warnings", warned);
  RecordProperty("refused", refused);
  RecordProperty("slowest_ms", std::to_string(1e3 * slowest));
  RecordProperty("slowest", slowest_name);
}

TEST(DirtyDescriptions, EveryFaultComesAloneFirst) {
  const std::vector<std::string> faults = dirtyFaults();
  ASSERT_LT(faults.size(), kDescriptions / 2);
  for (unsigned seed = 0; seed < faults.size(); ++seed) {
    EXPECT_EQ(dirtyDescription(seed).faults, std::vector<std::string>{faults[seed]});
  }
}

// VWD_ALL_DESCRIPTIONS=1 gives the tool all of them.
class DirtyFiles : public OfflineTool {};

TEST_F(DirtyFiles, TheToolPrintsOneLineAndNothingElse) {
  const bool all = std::getenv("VWD_ALL_DESCRIPTIONS") != nullptr;
  double slowest = 0;
  int codes[2] = {0, 0};
  for (unsigned seed = 0; seed < kDescriptions; seed += all ? 1 : kEvery) {
    const DirtyDescription dirty = dirtyDescription(seed);
    SCOPED_TRACE(named(seed, dirty));
    write("dirty.urdf", dirty.urdf);
    const auto start = std::chrono::steady_clock::now();
    const Run result = run("--urdf dirty.urdf --check");
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    slowest = std::max(slowest, time.count());
    ASSERT_TRUE(result.exit_code == 0 || result.exit_code == 1) << result.exit_code;
    ++codes[result.exit_code];
    if (result.exit_code == 0) {
      EXPECT_EQ(result.err, "");
    } else {
      ASSERT_FALSE(result.err.empty());
      EXPECT_TRUE(isOneLine(result.err.substr(0, result.err.size() - 1))) << result.err;
      EXPECT_EQ(result.err.back(), '\n');
    }
    std::istringstream lines(result.out);
    for (std::string line; std::getline(lines, line);) {
      if (line.compare(0, 8, "warning:") == 0) {
        EXPECT_TRUE(isOneLine(line)) << line;
      }
    }
  }
  RecordProperty("read", codes[0]);
  RecordProperty("refused", codes[1]);
  RecordProperty("slowest_ms", std::to_string(1e3 * slowest));
}

}  // namespace
}  // namespace virtual_work_dynamics
