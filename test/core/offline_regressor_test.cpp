#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "offline_linkage.h"
#include "offline_tool.h"

namespace virtual_work_dynamics {
namespace {

constexpr char kSwing[] =
    "time,position.hinge,velocity.hinge,acceleration.hinge\n0,0.5,0.25,0\n0.1,0.5,-2,3\n";
// A few roundings of these numbers.
constexpr double kRounded = 1e-13;

class OfflineRegressor : public OfflineTool {
 protected:
  void SetUp() override {
    OfflineTool::SetUp();
    write("p.urdf", kPendulum);
    write("m.csv", kSwing);
    write("s.yaml", "joints: [{name: hinge, damping: 0.5, coulomb: 2, coulomb_velocity: 1}]\n");
  }

  /// The numbers of a file whose header has that shape.
  std::vector<double> numbers(const std::string& name, const std::string& shape) const {
    const std::string bytes = readFile(path(name));
    EXPECT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8)) << name;
    const std::size_t start = bytes.find('\n') + 1;
    EXPECT_EQ(start % 64, 0u);
    EXPECT_EQ(static_cast<unsigned char>(bytes[8]) + 256u * static_cast<unsigned char>(bytes[9]),
              start - 10);
    const std::string header = bytes.substr(0, start);
    EXPECT_NE(header.find("'shape': " + shape + ", "), std::string::npos) << header;
    std::vector<double> values((bytes.size() - start) / sizeof(double));
    if (!values.empty()) std::memcpy(values.data(), &bytes[start], values.size() * sizeof(double));
    return values;
  }
  const std::string start_ = "--urdf p.urdf --motion m.csv --regressor r ";
};

TEST_F(OfflineRegressor, IsAFolderOfArrays) {
  const Run result = run(start_ + "--scene s.yaml");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "");
  const std::vector<double> effort = numbers("r/effort.npy", "(2,1,)");
  const std::vector<double> columns = numbers("r/regressor.npy", "(14,2,1,)");
  ASSERT_EQ(effort.size(), 2u);
  ASSERT_EQ(columns.size(), 28u);
  // damping, coulomb, rotor inertia, offset; then mass and so on of the bob.
  EXPECT_NEAR(columns[0], 0.25, kRounded);
  EXPECT_NEAR(columns[1], -2, kRounded);
  EXPECT_NEAR(columns[2], 0.25 * (3 - 0.0625) / 2, kRounded);
  EXPECT_NEAR(columns[5], 3, kRounded);
  EXPECT_NEAR(columns[6], 1, kRounded);
  // Mass and first moment along z of the bob, which is -1 kg m.
  EXPECT_NEAR(columns[8], 0, kRounded);
  EXPECT_NEAR(-columns[14], 9.81 * std::sin(0.5), kRounded);
  EXPECT_NEAR(effort[1], 9.81 * std::sin(0.5) + 0.53 * 3 + 0.5 * -2 - 2, kRounded);
  const std::string names = readFile(path("r/names.json"));
  for (const char* part :
       {"\"efforts\": [\"hinge\"]", "\"coordinates\": [\"hinge\"]", "\"units\": [\"rad\"]",
        "\"bodies\": [\"bob\"]", "{\"kind\": \"damping\", \"of\": \"hinge\", \"value\": 0.5}",
        "{\"kind\": \"first_moment_z\", \"of\": \"bob\", \"value\": -1}",
        "{\"kind\": \"inertia_yy\", \"of\": \"bob\", \"value\": 0.53}"}) {
    EXPECT_NE(names.find(part), std::string::npos) << part << names;
  }
}

TEST_F(OfflineRegressor, HasTheParametersThatAreAskedFor) {
  for (const auto& [list, shape] : {std::pair{"joints", "(4,2,1,)"},
                                    {"links", "(10,2,1,)"},
                                    {"bob", "(10,2,1,)"},
                                    {"joints,bob", "(14,2,1,)"}}) {
    const Run result = run(start_ + "--parameters " + list);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    numbers("r/regressor.npy", shape);
  }
  for (const auto& [list, problem] :
       {std::pair{"bobb", "--parameters: no link 'bobb'"},
        {"stand", "--parameters: no joint moves 'stand', so that no effort depends on its mass"},
        {"joints,,bob", "--parameters: there is an empty name in 'joints,,bob'"}}) {
    const Run result =
        run("--urdf p.urdf --motion m.csv --regressor new --parameters " + std::string(list));
    EXPECT_NE(result.exit_code, 0);
    EXPECT_NE(result.err.find(problem), std::string::npos) << result.err;
    EXPECT_FALSE(exists("new"));
  }
}

// Crank, coupler and rocker in one line do not hold what would turn the coupler.
TEST_F(OfflineRegressor, HasNoNumbersWhereThereAreNoEfforts) {
  write("l.urdf", kLinkage);
  write("l.yaml", pinned("0.5"));
  const LinkageState moving{0.3, 1, -2}, dead{1.5707963267948966, 0, 0};
  write("l.csv", kAllColumns + row(0, moving) + row(0.1, dead));
  const std::string input = "--urdf l.urdf --scene l.yaml --motion l.csv ";
  const NumberTable efforts = parseTable(run(input + "--reactions none").out);
  const Run result = run(input + "--regressor r --parameters coupler");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("warning: l.csv: 1 row in singular positions, first in line 3; efforts "
                            "without a value there"),
            std::string::npos)
      << result.err;
  const std::vector<double> described = numbers("r/effort.npy", "(2,3,)");
  const std::vector<double> columns = numbers("r/regressor.npy", "(10,2,3,)");
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(std::isnan(efforts.rows[1][i + 1]));
    EXPECT_TRUE(std::isnan(described[3 + i]));
    EXPECT_NEAR(described[i], efforts.rows[0][i + 1], kRounded);
    const std::size_t first_moment_x = 6 + i;  // of the first row; that of the second is 3 after it
    EXPECT_TRUE(std::isfinite(columns[first_moment_x]));
    EXPECT_TRUE(std::isnan(columns[first_moment_x + 3]));
  }
}

TEST_F(OfflineRegressor, TakesThePlaceOfAResult) {
  for (const char* other :
       {"--output o.csv", "--check", "--explain", "--axes child", "--reactions none",
        "--no-efforts", "--method lagrange", "--certificates", "--deviations", "--positions",
        "--axes inertial", "--report r", "--residuals", "--measured m.csv", "--effort-limits"}) {
    const Run result = run(start_ + other);
    EXPECT_EQ(result.exit_code, 2) << other;
    EXPECT_NE(result.err.find("is of no use with --regressor"), std::string::npos) << result.err;
    EXPECT_FALSE(exists("r"));
  }
  const Run alone = run("--urdf p.urdf --motion m.csv --parameters joints");
  EXPECT_EQ(alone.exit_code, 2);
  EXPECT_NE(alone.err.find("--parameters is of use with --regressor only"), std::string::npos);
}

TEST_F(OfflineRegressor, SaysWhenItCannotBeWritten) {
  write("r", "a file");
  const Run result = run(start_);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("r: cannot be made: "), std::string::npos) << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
}

}  // namespace
}  // namespace virtual_work_dynamics
