#include "contenders/robots.h"

#include <array>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <random>
#include <sstream>

#include "contenders/closed_scenes.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct Source {
  const char* name;
  const char* path;  // empty: made by chainUrdf
  int chain_links;
  std::array<double, 3> gravity;
};

// The pendulum's root link has its x axis downwards.
constexpr Source kSources[] = {
    {"pendulum", VWD_SOURCE_DIR "/urdf/composed_pendulum.urdf", 0, {9.81, 0, 0}},
    {"six_axis_arm", VWD_SOURCE_DIR "/urdf/six_axis_arm.urdf", 0, {0, 0, -9.81}},
    {"seven_axis_arm",
     VWD_SOURCE_DIR "/benchmark/contenders/seven_axis_arm.urdf",
     0,
     {0, 0, -9.81}},
    {"ur5", VWD_SHARED_DATA "/robots/ur5.urdf", 0, {0, 0, -9.81}},
    {"hyq", VWD_SHARED_DATA "/robots/hyq.urdf", 0, {0, 0, -9.81}},
    {"tiago_no_hand", VWD_SHARED_DATA "/robots/tiago_no_hand.urdf", 0, {0, 0, -9.81}},
    {"chain_2", "", 2, {0, 0, -9.81}},
    {"chain_10", "", 10, {0, 0, -9.81}},
    {"chain_100", "", 100, {0, 0, -9.81}},
    {"chain_1000", "", 1000, {0, 0, -9.81}},
};

const Source& sourceOf(const std::string& name) {
  for (const Source& source : kSources) {
    if (name == source.name) return source;
  }
  throw Error("there is no scene '" + name + "'");
}

// The standard's distributions give other numbers with another library; the engine does not.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0);
  }
  Eigen::Vector3d cube(double size) {
    const double x = uniform(-size, size), y = uniform(-size, size);
    return {x, y, uniform(-size, size)};
  }

 private:
  std::mt19937 engine_;
};

void writeVector(std::ostream& text, const char* name, const Eigen::Vector3d& v) {
  text << ' ' << name << "=\"" << v.x() << ' ' << v.y() << ' ' << v.z() << '"';
}

// A homogeneous cuboid somewhere near the joint.
void writeInertial(std::ostream& text, Random& random) {
  const double mass = random.uniform(0.5, 2);
  const double a = random.uniform(0.02, 0.1);
  const double b = random.uniform(0.02, 0.1);
  const double c = random.uniform(0.02, 0.1);
  text << "<inertial><origin";
  writeVector(text, "xyz", random.cube(0.05));
  writeVector(text, "rpy", random.cube(kPi));
  text << "/><mass value=\"" << mass << "\"/><inertia ixx=\"" << mass / 12 * (b * b + c * c)
       << "\" ixy=\"0\" ixz=\"0\" iyy=\"" << mass / 12 * (a * a + c * c) << "\" iyz=\"0\" izz=\""
       << mass / 12 * (a * a + b * b) << "\"/></inertial>";
}

std::vector<Motion> randomMotions(const Mechanism& mechanism) {
  Random random(2010);
  std::vector<Motion> motions;
  for (std::size_t n = 0; n < kStates; ++n) {
    motions.emplace_back(static_cast<Eigen::Index>(mechanism.coordinates().size()));
    Motion& motion = motions.back();
    for (Eigen::Index i = 0; i < motion.q.size(); ++i) {
      const Joint& joint = mechanism.joints()[mechanism.coordinates()[i]];
      const double range = joint.type == JointType::kPrismatic ? 0.3 : kPi;
      motion.q[i] = random.uniform(-range, range);
      motion.qd[i] = random.uniform(-2, 2);
      motion.qdd[i] = random.uniform(-5, 5);
    }
  }
  return motions;
}

}  // namespace

std::vector<std::string> sceneNames() {
  std::vector<std::string> names;
  for (const Source& source : kSources) names.emplace_back(source.name);
  for (const std::string& name : closedSceneNames()) names.push_back(name);
  return names;
}

std::string missingFile(const std::string& name) {
  if (isClosedScene(name)) return "";
  const Source& source = sourceOf(name);
  return source.chain_links > 0 || std::ifstream(source.path) ? "" : source.path;
}

std::string sceneUrdf(const std::string& name) {
  const Source& source = sourceOf(name);
  if (source.chain_links > 0) return chainUrdf(source.chain_links);
  std::ifstream file(source.path);
  if (!file) throw FileError(std::string(source.path) + ": cannot be read");
  return {std::istreambuf_iterator<char>(file), {}};
}

BenchmarkScene makeScene(const std::string& name) {
  if (isClosedScene(name)) return makeClosedScene(name);
  const std::array<double, 3>& gravity = sourceOf(name).gravity;
  Mechanism mechanism = readUrdf(sceneUrdf(name));
  std::vector<Motion> motions = randomMotions(mechanism);
  return {name, std::move(mechanism), Eigen::Vector3d(gravity.data()), std::move(motions)};
}

std::string chainUrdf(int links) {
  Random random(113);
  std::ostringstream text;
  text.precision(17);
  text << "<robot name=\"chain_" << links << "\">\n<link name=\"base\"/>\n";
  for (int i = 1; i <= links; ++i) {
    text << "<link name=\"link_" << i << "\">";
    writeInertial(text, random);
    text << "</link>\n<joint name=\"joint_" << i << "\" type=\"revolute\"><parent link=\"";
    if (i == 1) {
      text << "base";
    } else {
      text << "link_" << i - 1;
    }
    text << "\"/><child link=\"link_" << i << "\"/><origin";
    writeVector(text, "xyz", random.cube(0.05));
    writeVector(text, "rpy", random.cube(kPi));
    text << "/><axis";
    writeVector(text, "xyz", random.cube(1));
    text << "/><limit lower=\"-3.15\" upper=\"3.15\" effort=\"100\" velocity=\"10\"/></joint>\n";
  }
  text << "</robot>\n";
  return text.str();
}

}  // namespace virtual_work_dynamics
