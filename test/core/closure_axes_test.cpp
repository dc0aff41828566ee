#include "virtual_work_dynamics/closure_axes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "closed_loop_results.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/scene_reader.h"

namespace virtual_work_dynamics {
namespace {

// Two factorizations of a loop in general position, with ratios of some tens, against each other;
// those of a worse condition are not compared.
constexpr double kSameLoop = 1e-10, kWorstCondition = 1e4;

using Turn = Eigen::AngleAxis<long double>;

// A place in the root link.
struct Place {
  Matrix3l R = Matrix3l::Identity();
  Vector3l o = Vector3l::Zero();
};

Place within(const Place& frame, const Place& other) {  // other, as seen from frame
  return {frame.R.transpose() * other.R, frame.R.transpose() * (other.o - frame.o)};
}

// A loop of seven joints and six bodies behind each other, all of whose places are known, that is
// cut in two ways: at the seventh joint, which is then a closure, or at the first. A motor on the
// root link is coupled with joints of the loop.
class CutLoop {
 public:
  static constexpr int kJoints = 7;

  CutLoop(unsigned seed, bool slides) : generator_(seed), slides_(slides) {
    for (Place& joint : joints_) {
      joint.R = (Turn(uniform(-3, 3), Vector3l::UnitZ()) * Turn(uniform(-3, 3), Vector3l::UnitX()) *
                 Turn(uniform(-3, 3), Vector3l::UnitZ()))
                    .toRotationMatrix();
      joint.o = {uniform(-0.5, 0.5), uniform(-0.5, 0.5), uniform(-0.5, 0.5)};
    }
    for (int body = 0; body + 1 < kJoints; ++body) {
      Link link;
      link.mass = uniform(0.5, 2);
      link.p_KoCm_K = {uniform(-0.3, 0.3), uniform(-0.3, 0.3), uniform(-0.3, 0.3)};  // in the root
      const long double a = uniform(0.01, 0.02), b = uniform(0.01, 0.02), c = uniform(0.01, 0.02);
      link.inertia_Cm_K = Vector3l(a, b, c).asDiagonal();
      bodies_.push_back(link);
    }
    start_ = uniform(-3, 3);
    if (slides_) start_ *= 0.1;
  }

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }

  // j1 ... j6, and the closure j7; the motor.
  Mechanism cutAtLast() const {
    std::vector<Link> links(1);
    std::vector<Joint> joints;
    links[0].name = "root";
    for (int k = 0; k + 1 < kJoints; ++k) {
      add(links, joints, k, k, k == 0 ? Place() : joints_[at(k - 1)], joints_[at(k)], 1);
    }
    addMotor(links, joints);
    return Mechanism("a", links, joints);
  }
  // j7, then j6 to j2 backwards, and the closure j1.
  Mechanism cutAtFirst() const {
    std::vector<Link> links(1);
    std::vector<Joint> joints;
    links[0].name = "root";
    for (int k = kJoints - 1; k > 0; --k) {
      const bool first = k == kJoints - 1;
      add(links, joints, k, k - 1, first ? Place() : joints_[at(k + 1)], joints_[at(k)],
          first ? 1 : -1);
    }
    addMotor(links, joints);
    return Mechanism("b", links, joints);
  }

  // The last joint as a closure, which starts at start().
  Closure last() const {
    Closure closure;
    closure.name = "j7";
    closure.type = slides_ ? ClosureType::kPrismatic : ClosureType::kRevolute;
    closure.parent = frameIn("root", Place(), joints_[kJoints - 1]);
    Place child = joints_[kJoints - 1];
    if (slides_) {
      child.o += child.R.col(2) * start_;
    } else {
      child.R = child.R * Turn(start_, Vector3l::UnitZ()).toRotationMatrix();
    }
    closure.child = frameIn("body_5", joints_[kJoints - 2], child);
    return closure;
  }
  // The first joint as a closure, whose child is the first body.
  Closure first() const {
    Closure closure;
    closure.name = "j1";
    closure.type = ClosureType::kRevolute;
    closure.parent = frameIn("root", Place(), joints_[0]);
    closure.child = frameIn("body_0", joints_[1], joints_[0]);
    return closure;
  }
  double start() const { return start_; }
  // What the closure's child frame has slid by.
  Eigen::Vector3d lever() const {
    const Vector3l slid = joints_[kJoints - 1].R.col(2) * (slides_ ? start_ : 0);
    return slid.cast<double>();
  }

 private:
  static std::size_t at(int k) { return static_cast<std::size_t>(k); }

  static LinkFrame frameIn(const std::string& link, const Place& body, const Place& frame) {
    const Place seen = within(body, frame);
    const Vector3l zyx = seen.R.eulerAngles(2, 1, 0);
    LinkFrame result;
    result.link = link;
    result.xyz = seen.o.cast<double>();
    result.rpy = Vector3l(zyx[2], zyx[1], zyx[0]).cast<double>();
    return result;
  }

  // Adds joint k, behind which is a body, whose frame is the joint's.
  void add(std::vector<Link>& links, std::vector<Joint>& joints, int k, int body,
           const Place& parent, const Place& place, int sign) const {
    const int index = static_cast<int>(joints.size());
    const Place seen = within(parent, place);
    Joint joint;
    joint.name = "j" + std::to_string(k + 1);
    joint.type = slides_ && k == kJoints - 1 ? JointType::kPrismatic : JointType::kContinuous;
    joint.parent_link = index;
    joint.child_link = index + 1;
    joint.p_PoKo_P = seen.o;
    joint.R_PK = seen.R;
    joint.axis_K = sign * Vector3l::UnitZ();
    joint.coordinate = index;
    Link link = bodies_[at(body)];
    link.name = "body_" + std::to_string(body);
    link.parent_joint = index;
    link.p_KoCm_K = place.R.transpose() * (link.p_KoCm_K - place.o);
    link.inertia_Cm_K = place.R.transpose() * link.inertia_Cm_K * place.R;
    joints.push_back(joint);
    links.push_back(link);
  }

  static void addMotor(std::vector<Link>& links, std::vector<Joint>& joints) {
    const int index = static_cast<int>(joints.size());
    Joint joint;
    joint.name = "motor";
    joint.type = JointType::kContinuous;
    joint.child_link = index + 1;
    joint.axis_K = Vector3l::UnitZ();
    joint.coordinate = index;
    Link link;
    link.name = "rotor";
    link.parent_joint = index;
    link.mass = 0.3L;
    link.inertia_Cm_K = 1e-4L * Matrix3l::Identity();
    joints.push_back(joint);
    links.push_back(link);
  }

  std::mt19937 generator_;
  const bool slides_;
  Place joints_[kJoints];
  std::vector<Link> bodies_;
  double start_ = 0;
};

// A loop that is computed with its last joint as the axis of a closure, and as a joint.
struct BothCuts {
  BothCuts(CutLoop& loop, const std::string& scene_text)
      : scene(readScene(YAML::Load(scene_text))),
        cut_at_last(withClosureAxes(loop.cutAtLast(), with(loop.last()))),
        joint_mechanism(loop.cutAtFirst()),
        of_closure(cut_at_last.mechanism, cut_at_last.scene),
        of_joint(joint_mechanism, with(loop.first())),
        lever(loop.lever()) {}

  Scene with(const Closure& closure) const {
    Scene result = scene;
    result.closures = {closure};
    return result;
  }
  Eigen::Index closureAt(const std::string& name) const {
    return cut_at_last.mechanism.coordinateIndex(name);
  }
  Eigen::Index jointAt(const std::string& name) const {
    return joint_mechanism.coordinateIndex(name);
  }
  // Completes the motion of one coordinate in both, from where they are assembled. Returns whether
  // it exists.
  bool complete(const std::string& name, double shift, double start) {
    const double moved = name == "j7" ? start : 0;
    a = Motion(8);
    a.q = of_closure.dynamics.assembly();
    b = Motion(7);
    b.q = of_joint.dynamics.assembly();
    a.q[closureAt(name)] = moved + shift;
    b.q[jointAt(name)] = shift;
    a.qd[closureAt(name)] = b.qd[jointAt(name)] = 1.3;
    a.qdd[closureAt(name)] = b.qdd[jointAt(name)] = -2.1;
    std::vector<bool> given_a(8, false), given_b(7, false);
    given_a[static_cast<std::size_t>(closureAt(name))] = true;
    given_b[static_cast<std::size_t>(jointAt(name))] = true;
    return of_closure.dynamics.complete(a, given_a) && of_joint.dynamics.complete(b, given_b);
  }
  // Compares everything that both have at the motions. Returns the worst relative difference.
  double compare(double start) {
    of_closure.dynamics.compute(a);
    of_joint.dynamics.compute(b);
    double worst = 0, largest = 1;
    const auto differ = [&](double x, double y) {
      EXPECT_TRUE(std::isfinite(x) && std::isfinite(y));
      worst = std::max(worst, std::abs(x - y));
    };
    for (const char* name : {"j1", "j2", "j3", "j4", "j5", "j6", "j7"}) {
      const Wrench& x = of_closure.root(name);
      const Wrench& y = of_joint.root(name);
      // Where the chain is walked backwards, the bodies change parts.
      const double sign = name == std::string("j7") || name == std::string("j1") ? 1 : -1;
      const Eigen::Vector3d torque = y.torque - leverOf(name).cross(y.force);
      largest = std::max({largest, y.force.norm(), torque.norm()});
      for (int i = 0; i < 3; ++i) {
        differ(x.force[i], sign * y.force[i]);
        differ(x.torque[i], sign * torque[i]);
      }
      EXPECT_EQ(of_closure.rootDetermined(name), of_joint.rootDetermined(name)) << name;
    }
    for (const char* name : {"motor", "j3", "j7"}) {
      const double q = a.q[closureAt(name)] - (name == std::string("j7") ? start : 0);
      EXPECT_NEAR(q, b.q[jointAt(name)], kSameLoop * std::max(1.0, std::abs(q))) << name;
      differ(of_closure.dynamics.effort()[closureAt(name)],
             of_joint.dynamics.effort()[jointAt(name)]);
      largest = std::max(largest, std::abs(of_joint.dynamics.effort()[jointAt(name)]));
    }
    // That of the coupling.
    differ(of_closure.dynamics.effort()[8], of_joint.dynamics.effort()[7]);
    return worst / largest;
  }
  // From where the moment of a reaction is about in the one to where it is in the other.
  Eigen::Vector3d leverOf(const std::string& name) const {
    return name == "j7" ? lever : Eigen::Vector3d::Zero();
  }
  bool wellConditioned() const {
    return of_closure.dynamics.determinacy().condition < kWorstCondition;
  }

  const Scene scene;
  const SceneOfMechanism cut_at_last;
  const Mechanism joint_mechanism;
  ClosedLoopResults of_closure, of_joint;
  const Eigen::Vector3d lever;
  Motion a, b;
};

const std::string kGear =
    "couplings: [{name: gear, terms: [{name: motor, factor: 1}, {name: j7, factor: -40}, {name: "
    "j3, "
    "factor: 7}]}]\n";

// A gear between the closure of a loop, another joint of it and a motor.
TEST(ClosureAxes, AreJointsOfAnotherCut) {
  int compared = 0;
  double worst = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    CutLoop loop(seed, seed % 4 == 3);
    const std::string driven = seed % 3 == 0 ? "j7" : "motor";
    BothCuts both(loop, kGear + "actuated: [" + driven + "]");
    const std::string given = seed % 2 == 0 ? "motor" : "j7";
    const double shift = (seed % 5 == 0 ? 0 : 0.02) * (given == "motor" ? 40 : 1);
    if (!both.complete(given, shift, loop.start())) continue;  // beyond where the loop can move
    const double difference = both.compare(loop.start());
    if (!both.wellConditioned()) continue;
    ++compared;
    EXPECT_LE(difference, kSameLoop) << seed;
    worst = std::max(worst, difference);
  }
  EXPECT_GE(compared, 250);
  RecordProperty("worst", std::to_string(worst));
  std::printf("%d loops, worst difference %.1e\n", compared, worst);
}

}  // namespace
}  // namespace virtual_work_dynamics
