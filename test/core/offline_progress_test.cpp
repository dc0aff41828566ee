#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "offline/progress.h"

namespace virtual_work_dynamics {
namespace {

using Where = ProgressLine::Where;
constexpr Progress::Clock::duration kAtOnce{0};
constexpr Progress::Clock::duration kNever = std::chrono::hours(1);

TEST(Progress, ReplacesOneLineOfATerminalAndWipesItOut) {
  std::ostringstream terminal;
  {
    Progress progress(terminal, Where::kTerminal, "rows", kAtOnce);
    progress.update(0, 3);
    EXPECT_EQ(terminal.str(), "\r\033[Krows: 0 %");
  }
  EXPECT_EQ(terminal.str(), "\r\033[Krows: 0 %\r\033[K");
}

TEST(Progress, AddsALineToALog) {
  std::ostringstream log;
  {
    Progress progress(log, Where::kLog, "rows", kAtOnce);
    progress.update(0, 3);
    progress.update(2, 3);  // half a minute would have to pass
  }
  EXPECT_EQ(log.str(), "rows: 0 %\n");
}

TEST(Progress, IsSilentForShortWork) {
  for (const Where where : {Where::kTerminal, Where::kLog}) {
    std::ostringstream stream;
    { Progress(stream, where, "rows", kNever).update(1, 3); }
    { Progress(stream, where, "rows").update(1, 3); }
    EXPECT_EQ(stream.str(), "");
  }
}

TEST(Progress, IsSilentWhereNothingIsToBeShown) {
  std::ostringstream stream;
  { Progress(stream, Where::kNowhere, "rows", kAtOnce).update(1, 3); }
  EXPECT_EQ(stream.str(), "");
}

TEST(Progress, TellsTheTimeThatIsLeft) {
  EXPECT_EQ(partDone(1, 3, 6), ": 33 %, 12 s left");
  EXPECT_EQ(partDone(1, 101, 2), ": 0 %, 3 min left");
  EXPECT_EQ(partDone(1, 10, 1000), ": 10 %, 3 h left");
  EXPECT_EQ(partDone(3, 3, 6), ": 100 %");
  EXPECT_EQ(partDone(0, 3, 6), ": 0 %");
}

TEST(Progress, CountsWorkOfUnknownLength) {
  EXPECT_EQ(countDone(1200, "rows", 4), ": 1200 rows, 300 each second");
  std::ostringstream log;
  { Progress(log, Where::kLog, "reading", kAtOnce).updateCount(7, "rows"); }
  EXPECT_EQ(log.str().rfind("reading: 7 rows", 0), 0u) << log.str();
}

}  // namespace
}  // namespace virtual_work_dynamics
