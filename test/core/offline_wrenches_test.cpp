#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "base/number_text.h"
#include "offline_linkage.h"

namespace virtual_work_dynamics {
namespace {

constexpr char kWrench[] =
    ",wrench.push.fx,wrench.push.fy,wrench.push.fz,wrench.push.tx,"
    "wrench.push.ty,wrench.push.tz";
constexpr char kValues[] = "30,-4,12.5,0.5,-2,1";
constexpr char kScene[] =
    "applied_wrenches:\n  - {name: push, link: LINK, at: [0.1, 0, 0.2], axes: AXES, force: FORCE, "
    "torque: TORQUE}\n";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

std::string sceneOf(const std::string& link, const std::string& axes,
                    const std::string& force = "[0, 0, 0]",
                    const std::string& torque = "[0, 0, 0]") {
  return replaced(replaced(replaced(replaced(kScene, "LINK", link), "AXES", axes), "FORCE", force),
                  "TORQUE", torque);
}

/// Adds columns to each line of a CSV.
std::string withColumns(const std::string& csv, const std::string& names,
                        const std::vector<std::string>& values) {
  std::istringstream lines(csv);
  std::string text, line;
  std::getline(lines, line);
  text = line + names + "\n";
  for (std::size_t i = 0; std::getline(lines, line); ++i) {
    text += line + "," + values[i % values.size()] + "\n";
  }
  return text;
}

class OfflineWrenches : public OfflineLoops {
 protected:
  void SetUp() override {
    OfflineLoops::SetUp();
    write("crane.urdf", kCrane);
    crane_ =
        "time,position.slide,position.shoulder,velocity.slide,velocity.shoulder,"
        "acceleration.slide,acceleration.shoulder\n";
    linkage_ = kAllColumns;
    for (int i = 0; i < 600; ++i) {  // more rows than are computed at once
      const double t = 0.001 * i;
      crane_ += numberText(t) + "," + numberText(0.1 * t) + "," + numberText(t * t) + ",0.1," +
                numberText(2 * t) + ",0,2\n";
      linkage_ += row(t, {0.3 + t, 1, 0.5});
    }
  }

  /// What a run prints; it must succeed.
  std::string output(const std::string& arguments) {
    const Run result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.out;
  }

  std::string crane_, linkage_;
};

// The same text, whatever the way to compute: open or closed, with checks, by Lagrange.
TEST_F(OfflineWrenches, ColumnsOfAConstantAreThatOfTheScene) {
  const std::string loop = pinned("0.5");
  for (const char* axes : {"link", "root"}) {
    write("crane_fixed.yaml", sceneOf("jib", axes, "[30, -4, 12.5]", "[0.5, -2, 1]"));
    write("crane_columns.yaml", sceneOf("jib", axes, "[1, 1, 1]"));
    write("loop_fixed.yaml", loop + sceneOf("rocker", axes, "[30, -4, 12.5]", "[0.5, -2, 1]"));
    write("loop_columns.yaml", loop + sceneOf("rocker", axes, "[1, 1, 1]"));
    for (const char* robot : {"crane", "loop"}) {
      const bool crane = robot == std::string("crane");
      const std::string& motion = crane ? crane_ : linkage_;
      write("fixed.csv", motion);
      write("columns.csv", withColumns(motion, kWrench, {kValues}));
      const std::string urdf = crane ? "--urdf crane.urdf" : "--urdf l.urdf";
      for (const char* how : {"", " --threads 3 --axes child", " --certificates",
                              " --method lagrange", " --deviations"}) {
        const std::string tolerances = " --deviations" == std::string(how) ? "d" : "";
        for (const char* name : {"_fixed.yaml", "_columns.yaml"}) {
          const std::string scene = robot + std::string(name);
          write("d" + scene, readFile(path(scene)) + "tolerances: {mass: 0.1}\n");
        }
        const std::string start = urdf + how + " --scene " + tolerances + robot;
        const std::string expected = output(start + "_fixed.yaml --motion fixed.csv");
        EXPECT_EQ(output(start + "_columns.yaml --motion columns.csv"), expected) << robot << how;
        EXPECT_NE(output(start + "_columns.yaml --motion fixed.csv"), expected) << robot << how;
      }
    }
  }
}

// A live wrench of the tool acts about the link's origin in its axes, and may be inverted.
TEST_F(OfflineWrenches, LiveOnesAreAboutTheOriginOfTheirLink) {
  write("m.csv", crane_);
  write("w.csv", withColumns(crane_, kWrench, {kValues}));
  const std::string live = "applied_wrenches: [{name: push, link: jib, live: true";
  const std::string fixed = "applied_wrenches: [{link: jib, ";
  write("live.yaml", live + "}]\n");
  write("inverted.yaml", live + ", invert: true}]\n");
  write("plus.yaml", fixed + "force: [30, -4, 12.5], torque: [0.5, -2, 1]}]\n");
  write("minus.yaml", fixed + "force: [-30, 4, -12.5], torque: [-0.5, 2, -1]}]\n");
  const std::string start = "--urdf crane.urdf --scene ";
  EXPECT_EQ(output(start + "live.yaml --motion w.csv"), output(start + "plus.yaml --motion m.csv"));
  EXPECT_EQ(output(start + "inverted.yaml --motion w.csv"),
            output(start + "minus.yaml --motion m.csv"));
}

// Each row has its own: all at once are what runs of one load each print for these rows.
TEST_F(OfflineWrenches, RowsHaveTheirOwn) {
  const std::vector<std::string> values = {"30,-4,12.5,0.5,-2,1", "0,0,0,0,0,0",
                                           "-7,2,5,1,3,-0.25"};
  const std::string loop = pinned("0.5");
  write("crane.yaml", sceneOf("jib", "root"));
  write("loop.yaml", loop + sceneOf("rocker", "root"));
  for (const bool crane : {true, false}) {
    const std::string start =
        crane ? "--urdf crane.urdf --scene crane.yaml" : "--urdf l.urdf --scene loop.yaml";
    const std::string& motion = crane ? crane_ : linkage_;
    write("all.csv", withColumns(motion, kWrench, values));
    const NumberTable all = parseTable(output(start + " --threads 2 --motion all.csv"));
    for (std::size_t k = 0; k < values.size(); ++k) {
      write("one.csv", withColumns(motion, kWrench, {values[k]}));
      const NumberTable one = parseTable(output(start + " --motion one.csv"));
      ASSERT_EQ(one.rows.size(), 600u);
      for (std::size_t i = k; i < one.rows.size(); i += values.size()) {
        EXPECT_EQ(all.rows[i], one.rows[i]) << i;
      }
      EXPECT_NE(all.rows[k + 1], one.rows[k + 1]);
    }
  }
}

TEST_F(OfflineWrenches, AreRefusedInOneLine) {
  write("s.yaml", pinned("0.5") + "applied_wrenches: [{name: push, link: rocker, live: true}]\n");
  const std::string start = "--scene s.yaml --motion m.csv";
  write("m.csv", linkage_);
  EXPECT_EQ(failure(start),
            "m.csv: column 'wrench.push.fx' is missing: the applied wrench 'push' is live");
  write("m.csv", withColumns(linkage_, replaced(kWrench, ",wrench.push.tz", ""), {"1,2,3,4,5"}));
  EXPECT_EQ(failure(start),
            "m.csv: line 1: column 'wrench.push.tz' is missing: a wrench has all six");
  write("m.csv", withColumns(linkage_, std::string(kWrench) + ",wrench.push.f", {"1,2,3,4,5,6,7"}));
  EXPECT_EQ(failure(start),
            "m.csv: line 1, column 17: 'wrench.push.f' is not one of time, position.<joint>, "
            "velocity.<joint>, acceleration.<joint>, wrench.<name>.{fx,fy,fz,tx,ty,tz}");
  write("m.csv", withColumns(linkage_, kWrench, {"1,2,nan,4,5,6"}));
  EXPECT_EQ(failure(start),
            "m.csv: line 2, column 13 (wrench.push.fz): 'nan' is not a finite number");
  write("s.yaml", pinned("0.5") + "applied_wrenches: [{name: pull, link: rocker}]\n");
  write("m.csv", withColumns(linkage_, kWrench, {kValues}));
  EXPECT_EQ(failure(start),
            "m.csv: column 'wrench.push.fx': the scene has no applied wrench 'push'; known are "
            "'pull'");
}

}  // namespace
}  // namespace virtual_work_dynamics
