#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "offline/progress.h"

namespace virtual_work_dynamics {
namespace {

constexpr Progress::Clock::duration kAtOnce{0};
constexpr Progress::Clock::duration kNever = std::chrono::hours(1);

TEST(Progress, ShowsThePercentageOnOneLineAndWipesItOut) {
  std::ostringstream terminal;
  {
    Progress progress(terminal, true, kAtOnce);
    progress.update(1, 3);
    EXPECT_EQ(terminal.str(), "\r33 %");
  }
  EXPECT_EQ(terminal.str(), "\r33 %\r     \r");
}

TEST(Progress, WipesOutEveryDigitOfThePercentage) {
  std::ostringstream terminal;
  { Progress(terminal, true, kAtOnce).update(2, 2); }
  EXPECT_EQ(terminal.str(), "\r100 %\r     \r");
}

TEST(Progress, IsSilentForShortWork) {
  std::ostringstream terminal;
  { Progress(terminal, true, kNever).update(1, 3); }
  EXPECT_EQ(terminal.str(), "");
}

TEST(Progress, IsSilentWithoutATerminal) {
  std::ostringstream terminal;
  { Progress(terminal, false, kAtOnce).update(1, 3); }
  EXPECT_EQ(terminal.str(), "");
}

}  // namespace
}  // namespace virtual_work_dynamics
