#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "offline_linkage.h"

namespace virtual_work_dynamics {
namespace {

// Terms of four bodies are rounded a dozen times each; relative to their magnitudes.
constexpr double kRounding = 2e-15;
// One formalism against the other, of results of some hundred at most; equal to the largest's
// digits.
constexpr double kFormalisms = 1e-12;

constexpr char kPoints[] =
    "moments_about: [{name: wrist, frame: parent, at: [0, 0, 0.1]}, "
    "{name: pin, link: base, at: [0.1, 0, 0.2]}]\n";

std::string motionOfAll(std::initializer_list<LinkageState> states) {
  std::string text = kAllColumns;
  double time = 0;
  for (const LinkageState& state : states) text += row(time += 0.1, state);
  return text;
}

class OfflineLoopChecks : public OfflineLoops {
 protected:
  void SetUp() override {
    OfflineLoops::SetUp();
    write("m.csv", motionOfAll({{0, 0, 0}, {0.3, -1.2, 2.5}, {-0.8, 3, -1}, {1.2, 0.5, 7}}));
  }

  /// Results of a scene with the linkage's motion.
  NumberTable results(const std::string& scene, const std::string& options) const {
    write("s.yaml", scene);
    const Run result = run("--urdf l.urdf --scene s.yaml --motion m.csv " + options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return parseTable(result.out);
  }

  static std::string sprung(const std::string& scene) {
    return scene +
           "springs: [{name: s, link_a: base, at_a: [0.1, 0, 0.7], link_b: coupler, "
           "at_b: [0.2, 0, 0], stiffness: 300, rest_length: 0.1}]\n"
           "joints: [{name: wrist, stiffness: 20, damping: 3}]\n";
  }
};

TEST_F(OfflineLoopChecks, CertificatesFollowUnchangedColumns) {
  for (const std::string options :
       {"", "--no-efforts", "--axes child", "--axes child --reactions elbow,pin",
        "--axes child --reactions ground,pin", "--reactions none --no-efforts",
        "--method lagrange --axes child --reactions pin,wrist --no-efforts"}) {
    for (const std::string& scene : {pinned("0.5"), sprung(pinned("0.5", "pin"))}) {
      write("s.yaml", scene);
      const std::string start = "--urdf l.urdf --scene s.yaml --motion m.csv " + options;
      const Run plain = run(start), certified = run(start + " --certificates");
      ASSERT_EQ(certified.exit_code, 0) << certified.err;
      EXPECT_NE(certified.out.find(kCertificateColumns), std::string::npos) << options;
      EXPECT_EQ(withoutCertificates(certified.out), plain.out) << options;
      EXPECT_NE(
          certified.err.find("note: m.csv: certificates judge arithmetic, not input: certificate."),
          std::string::npos);
      for (const std::vector<double>& row : parseTable(certified.out).rows) {
        for (std::size_t i = row.size() - 3; i < row.size(); ++i) {
          EXPECT_TRUE(row[i] >= 0 && row[i] <= kRounding) << row[i];
        }
      }
    }
  }
}

TEST_F(OfflineLoopChecks, SingularPositionsAreNotCertified) {
  const double flat = std::acos(0.0);
  write("m.csv", motionOfAll({{0.3, 1, 0}, {flat, 1, 0}}));
  write("s.yaml", pinned("0.5"));
  const Run result = run("--urdf l.urdf --scene s.yaml --motion m.csv --certificates");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("; 1 row not certified: singular positions\n"), std::string::npos)
      << result.err;
  const NumberTable table = parseTable(result.out);
  EXPECT_TRUE(std::isfinite(table.rows.at(0).back()));
  EXPECT_TRUE(std::isnan(table.rows.at(1).back()));
}

// The pin is at (0.5, 0, 0) in the base, whose axes are the root's.
TEST_F(OfflineLoopChecks, MomentsAreAboutThePointsOfTheScene) {
  const std::string options = "--reactions wrist,pin";
  const NumberTable plain = results(pinned("0.5"), options);
  const NumberTable moved = results(pinned("0.5") + kPoints, options);
  ASSERT_EQ(moved.header, plain.header);
  const auto place = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find(plain.header.begin(), plain.header.end(), name) -
                                    plain.header.begin());
  };
  for (std::size_t i = 0; i < plain.rows.size(); ++i) {
    const std::vector<double>&a = plain.rows[i], &b = moved.rows[i];
    const double lever_x = 0.5 - 0.1, lever_z = 0 - 0.2;
    const double fx = a[place("reaction.pin.fx")], fz = a[place("reaction.pin.fz")];
    EXPECT_NEAR(b[place("reaction.pin.ty")],
                a[place("reaction.pin.ty")] + lever_z * fx - lever_x * fz, kFormalisms);
    EXPECT_EQ(b[place("reaction.pin.fx")], fx);
    EXPECT_EQ(b[place("effort.drive")], a[place("effort.drive")]);
    EXPECT_NE(b[place("reaction.wrist.ty")], a[place("reaction.wrist.ty")]);
  }
}

TEST_F(OfflineLoopChecks, PointsOfMomentsAreListed) {
  write("s.yaml", pinned("0.5") + kPoints);
  const Run listed = run("--urdf l.urdf --scene s.yaml --check");
  EXPECT_EQ(listed.exit_code, 0) << listed.err;
  EXPECT_NE(listed.out.find("moments at:   wrist: parent frame at 0 0 0.1, "
                            "pin: link base at 0.1 0 0.2\n"),
            std::string::npos)
      << listed.out;
  const Run others = run("--urdf l.urdf --scene s.yaml --reactions drive --check");
  EXPECT_EQ(others.out.find("moments at"), std::string::npos) << others.out;
}

TEST_F(OfflineLoopChecks, LagrangesEquationsGiveTheSame) {
  for (const std::string& scene :
       {pinned("0.5"), sprung(pinned("0.5", "pin")),
        sprung(pinned("0.5")) + "include_active: false\n", pinned("0.5") + kPoints}) {
    for (const std::string axes : {"root", "child"}) {
      const std::string options = "--reactions ground,drive,elbow,wrist,pin --axes " + axes;
      const NumberTable one = results(scene, options);
      const NumberTable other = results(scene, options + " --method lagrange");
      ASSERT_EQ(one.header, other.header);
      bool different = false;
      for (std::size_t i = 0; i < one.rows.size(); ++i) {
        for (std::size_t j = 0; j < one.header.size(); ++j) {
          ASSERT_TRUE(std::isfinite(other.rows[i][j])) << one.header[j];
          EXPECT_NEAR(one.rows[i][j], other.rows[i][j], kFormalisms) << one.header[j];
          different = different || one.rows[i][j] != other.rows[i][j];
        }
      }
      EXPECT_TRUE(different) << "some digits are rounded otherwise";
    }
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
