#include "contenders/linkages.h"

#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace virtual_work_dynamics {
namespace {

constexpr long double kRods[] = {0.20L, 0.26L};  // m
constexpr long double kSpacing = 0.3L;           // m, of the rods and of couplers' ends
constexpr long double kDensity = 2.5L;           // kg/m
constexpr long double kRadius = 0.01L;           // m

std::string numbered(const char* name, int number) {
  char text[32];
  std::snprintf(text, sizeof(text), "%s_%03d", name, number);
  return text;
}

Matrix3l aboutZ(long double cosine, long double sine) {
  Matrix3l R;
  R << cosine, -sine, 0, sine, cosine, 0, 0, 0, 1;
  return R;
}

// Bars that turn about z, x along each bar, y of the base upwards. Joints are named after their
// bars.
class Bars {
 public:
  Bars() : links_(1) {
    links_[0].name = "base";
    scene_.gravity = {0, -9.81, 0};
    scene_.actuated.emplace();
  }

  // Bar on `parent` at `at`, whose x axis is turned by R. Returns its link.
  int add(const std::string& name, int parent, const Vector3l& at, const Matrix3l& R,
          long double length) {
    Joint joint;
    joint.name = name;
    joint.type = JointType::kContinuous;
    joint.parent_link = parent;
    joint.child_link = static_cast<int>(links_.size());
    joint.p_PoKo_P = at;
    joint.R_PK = R;
    joint.axis_K = Vector3l::UnitZ();
    joint.coordinate = static_cast<int>(joints_.size());
    Link link;
    link.name = name;
    link.parent_joint = static_cast<int>(joints_.size());
    link.mass = kDensity * length;
    link.p_KoCm_K = {length / 2, 0, 0};
    const long double across = link.mass * length * length / 12;
    link.inertia_Cm_K.diagonal() << link.mass * kRadius * kRadius / 2, across, across;
    joints_.push_back(joint);
    links_.push_back(link);
    return joint.child_link;
  }

  // Hangs with its tip at the height of the base's origin.
  int addRod(const std::string& name, long double x, long double length) {
    return add(name, 0, {x, length, 0}, aboutZ(0, -1), length);
  }

  // From the tip of a hanging rod to that of its neighbour: along its y axis.
  int addCoupler(const std::string& name, int rod, long double length) {
    return add(name, rod, {length, 0, 0}, aboutZ(0, 1), kSpacing);
  }

  // The joint of a coupler and its neighbour's tip.
  void close(const std::string& name, int coupler, int rod, long double length) {
    Closure pin;
    pin.name = name;
    pin.type = ClosureType::kRevolute;
    pin.parent.link = links_[static_cast<std::size_t>(coupler)].name;
    pin.parent.xyz.x() = static_cast<double>(kSpacing);
    pin.child.link = links_[static_cast<std::size_t>(rod)].name;
    pin.child.xyz.x() = static_cast<double>(length);
    scene_.closures.push_back(pin);
  }

  void actuate(const std::string& name) { scene_.actuated->push_back(name); }

  Linkage build(const std::string& name) {
    return {Mechanism(name, std::move(links_), std::move(joints_)), std::move(scene_)};
  }

 private:
  std::vector<Link> links_;
  std::vector<Joint> joints_;
  Scene scene_;
};

}  // namespace

Linkage separateFourBars(int loops) {
  Bars bars;
  for (int i = 0; i < loops; ++i) {
    const std::string loop = numbered("loop", i);
    const long double x = 2 * kSpacing * i;
    const int crank = bars.addRod(loop + "_crank", x, kRods[0]);
    const int coupler = bars.addCoupler(loop + "_coupler", crank, kRods[0]);
    const int rocker = bars.addRod(loop + "_rocker", x + kSpacing, kRods[1]);
    bars.close(loop + "_pin", coupler, rocker, kRods[1]);
    bars.actuate(loop + "_crank");
  }
  return bars.build("separate_four_bars");
}

Linkage sharedRods(int loops) {
  Bars bars;
  int coupler = 0;
  for (int i = 0; i <= loops; ++i) {
    const long double length = kRods[i % 2];
    const int rod = bars.addRod(numbered("rod", i), kSpacing * i, length);
    if (i > 0) bars.close(numbered("pin", i), coupler, rod, length);
    if (i < loops) {
      coupler = bars.addCoupler(numbered("coupler", i + 1), rod, length);
    }
  }
  bars.actuate(numbered("rod", 0));
  return bars.build("shared_rods");
}

}  // namespace virtual_work_dynamics
