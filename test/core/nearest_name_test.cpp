#include "base/nearest_name.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace virtual_work_dynamics {
namespace {

// The distance straight from its definition, by recursion.
std::size_t definedDistance(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty()) return a.size() + b.size();
  const std::string a1 = a.substr(1), b1 = b.substr(1);
  std::size_t least = std::min({definedDistance(a1, b) + 1, definedDistance(a, b1) + 1,
                                definedDistance(a1, b1) + (a[0] == b[0] ? 0 : 1)});
  if (a.size() > 1 && b.size() > 1 && a[0] == b[1] && a[1] == b[0]) {
    least = std::min(least, definedDistance(a.substr(2), b.substr(2)) + 1);
  }
  return least;
}

TEST(NearestName, DistancesOfSmallWords) {
  EXPECT_EQ(editDistance("slidr", "slider", 9), 1u);
  EXPECT_EQ(editDistance("sldier", "slider", 9), 1u);
  EXPECT_EQ(editDistance("kitten", "sitting", 9), 3u);
  EXPECT_EQ(editDistance("ca", "abc", 9), 3u);  // no letter is touched twice
  EXPECT_EQ(editDistance("", "abc", 9), 3u);
  EXPECT_EQ(editDistance("abc", "abc", 0), 0u);
}

TEST(NearestName, DistancesAreThoseOfTheDefinition) {
  std::mt19937_64 generator(7);
  for (int i = 0; i < 2000; ++i) {
    std::string words[2];
    for (std::string& word : words) {
      for (std::size_t length = generator() % 7; length > 0; --length) {
        word += static_cast<char>('a' + generator() % 3);
      }
    }
    const std::size_t expected = definedDistance(words[0], words[1]);
    for (const std::size_t most : {std::size_t{0}, std::size_t{2}, std::size_t{9}}) {
      EXPECT_EQ(editDistance(words[0], words[1], most), std::min(expected, most + 1))
          << words[0] << " " << words[1] << " " << most;
    }
  }
}

TEST(NearestName, MisspeltNamesFindTheirOwn) {
  const std::vector<std::string> known = {"crank", "slider", "left_knee_joint", "right_knee_joint"};
  EXPECT_EQ(nearestName("slidr", known), "slider");
  EXPECT_EQ(nearestName("Slider", known), "slider");
  EXPECT_EQ(nearestName("carnk", known), "crank");
  EXPECT_EQ(nearestName("left_knee_jiont", known), "left_knee_joint");
  EXPECT_EQ(nearestName("left_knee", known), "left_knee_joint");
  EXPECT_EQ(nearestName("knee", known), "");  // which one?
  EXPECT_EQ(nearestName("elbow", known), "");
  EXPECT_EQ(nearestName("", known), "");
  EXPECT_EQ(nearestName("crank", {}), "");
}

TEST(NearestName, NumberedNamesAreNotMisspeltOnes) {
  EXPECT_EQ(nearestName("joint_7", {"joint_1", "joint_2"}), "");
  EXPECT_EQ(nearestName("joint_12", {"joint_1", "joint_2"}), "");
  EXPECT_EQ(nearestName("jiont_2", {"joint_1", "joint_2"}), "joint_2");
}

TEST(NearestName, HelpListsWhatIsKnownWhenNothingIsNear) {
  EXPECT_EQ(nameHelp("slidr", {"crank", "slider"}), "; did you mean 'slider'?");
  EXPECT_EQ(nameHelp("j7", {"j1", "j2"}), "; known are 'j1' and 'j2'");
  EXPECT_EQ(nameHelp("j7", {}), "");
  const std::string help = nameHelp("j7", std::vector<std::string>(1000, std::string(500, 'x')));
  EXPECT_LT(help.size(), 1000u);
  EXPECT_NE(help.find(" and 988 more"), std::string::npos) << help;
}

}  // namespace
}  // namespace virtual_work_dynamics
