#include "robot/unit_doubts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "base/number_text.h"
#include "base/printable.h"

namespace virtual_work_dynamics {

namespace {

constexpr long double kFar = 10;          // times the size of the robot
constexpr long double kLeastFar = 1;      // m: nothing nearer is doubted
constexpr long double kUnknownSize = 2;   // m, of a robot whose joints are all in one place
constexpr long double kLongest = 50;      // m, from joint to joint
constexpr long double kLight = 10;        // kg for each of these metres, as no large machine is
constexpr long double kSteel = 7850;      // kg/m^3
constexpr long double kLeastSize = 0.3L;  // m, where masses are judged

struct InertiaUnit {
  const char* name;
  long double in_si;
};
constexpr std::array<InertiaUnit, 4> kInertiaUnits{
    {{"g mm^2", 1e-9L}, {"g cm^2", 1e-7L}, {"kg mm^2", 1e-6L}, {"kg cm^2", 1e-4L}}};

std::string text(long double value) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.4Lg", value);
  return digits;
}

// About the axis with the largest moment.
long double gyrationOf(const Link& link) {
  const long double moment = link.inertia_Cm_K.diagonal().cwiseAbs().maxCoeff();
  return link.mass > 0 ? std::sqrt(moment / link.mass) : 0;
}

// Whether a joint only says where the robot stands in its world.
bool places(const Joint& joint, const std::vector<Link>& links) {
  return joint.type == JointType::kFixed && joint.parent_link == 0 && links[0].mass == 0;
}

// The sum of the distances from joint to joint, which no chain of the robot is longer than; 0 when
// all are in one place. A distance of more than ten times all others together is left out: it is
// itself in doubt, or a place in the world.
long double sizeOf(const std::vector<Link>& links, const std::vector<Joint>& joints) {
  long double sum = 0, longest = 0;
  for (const Joint& joint : joints) {
    if (places(joint, links)) continue;
    const long double distance = joint.p_PoKo_P.norm();
    sum += distance;
    longest = std::max(longest, distance);
  }
  const long double others = sum - longest;
  return others > 0 && longest > kFar * others ? others : sum;
}

// How far the slides reach together.
long double travelOf(const std::vector<Joint>& joints) {
  long double sum = 0;
  for (const Joint& joint : joints)
    if (joint.type == JointType::kPrismatic && joint.lower < joint.upper)
      sum += std::min<long double>(joint.upper - joint.lower, kLongest);
  return sum;
}

std::string inertiaUnits(const Link& link, long double gyration, long double size) {
  std::string units;
  for (const InertiaUnit& unit : kInertiaUnits) {
    const long double radius = gyration * std::sqrt(unit.in_si);
    if (radius < size / 1000 || radius > size) continue;
    units += (units.empty() ? "" : " or ") + std::string(unit.name);
  }
  const std::string moment = text(link.inertia_Cm_K.diagonal().cwiseAbs().maxCoeff());
  return units.empty() ? ": is its mass or its inertia of " + moment + " kg m^2 wrong?"
                       : ": is its inertia of " + moment + " in " + units + " instead of kg m^2?";
}

class Judge {
 public:
  Judge(const std::vector<Link>& links, const std::vector<Joint>& joints)
      : links_(links), joints_(joints), size_(sizeOf(links, joints)), travel_(travelOf(joints)) {}

  std::vector<Doubt> judge() {
    for (const Joint& joint : joints_) judgeOrigin(joint);
    for (const Link& link : links_) judgeLink(link);
    judgeMass();
    for (const Joint& joint : joints_) judgeLimits(joint);
    return std::move(doubts_);
  }

 private:
  std::string sizeText() const {
    return size_ > 0 ? "on a robot of " + text(size_) + " m"
                     : "on a robot whose joints are all in one place";
  }

  void judgeOrigin(const Joint& joint) {
    const long double distance = joint.p_PoKo_P.norm();
    if (distance <= kLongest || places(joint, links_)) return;
    long double mass = 0;
    for (const Link& link : links_) mass += link.mass;
    if (mass > kLight * distance) return;  // as that of a wind turbine or a crane
    doubts_.push_back({"joint " + inQuotes(joint.name) + ": its origin is " + text(distance) +
                       " m from that of its parent: is it in mm?"});
  }

  void judgeLink(const Link& link) {
    const long double size = size_ > 0 ? size_ : kUnknownSize;
    const long double far = std::max(kFar * size, kLeastFar);
    const long double gyration = gyrationOf(link), centre = link.p_KoCm_K.norm();
    const std::string who = "link " + inQuotes(link.name) + ": ";
    if (gyration > far) {
      doubts_.push_back({who + "radius of gyration " + text(gyration) + " m " + sizeText() +
                             inertiaUnits(link, gyration, size),
                         true});
    }
    if (link.mass > 0 && centre > far) {
      doubts_.push_back({who + "centre of mass " + text(centre) + " m from its origin " +
                             sizeText() + ": is it in mm?",
                         true});
    }
  }

  // Whether a link's mass can be judged by a size: not that of a point, nor, where no distance is
  // known, that of an inertia that may stand for none.
  bool hasSize(const Link& link) const {
    const Vector3l moments = link.inertia_Cm_K.diagonal();
    const bool alike = moments.x() == moments.y() && moments.y() == moments.z();
    return moments.cwiseAbs().maxCoeff() > 0 && (size_ + travel_ > 0 || !alike);
  }

  void judgeMass() {
    long double mass = 0, size = std::max(size_ + travel_, kLeastSize);
    const Link* heaviest = &links_[0];
    for (const Link& link : links_) {
      if (!hasSize(link)) continue;
      mass += link.mass;
      if (link.mass > heaviest->mass) heaviest = &link;
      if (link.mass > 0) size = std::max({size, 2 * gyrationOf(link), link.p_KoCm_K.norm()});
    }
    if (mass <= kSteel * size * size * size) return;
    doubts_.push_back({"link " + inQuotes(heaviest->name) + ": mass " + text(heaviest->mass) +
                       " kg, the heaviest of a robot of " + text(size) + " m and " + text(mass) +
                       " kg, more than steel of that size weighs: is it in g?"});
  }

  // Limits in degrees are multiples of five to both sides, one from 30 on; powers of ten and such
  // stand for none, and shafts and winches turn from 0 on.
  void judgeLimits(const Joint& joint) {
    if (joint.type != JointType::kRevolute || !(joint.lower < joint.upper)) return;
    if (joint.lower >= 0 || joint.upper <= 0) return;
    const double most = std::max(-joint.lower, joint.upper);
    const bool fives = std::fmod(joint.lower, 5) == 0 && std::fmod(joint.upper, 5) == 0;
    constexpr std::array<double, 4> kRound{50, 100, 200, 500};
    const bool round = std::find(kRound.begin(), kRound.end(), most) != kRound.end();
    if (most < 30 || most > 720 || !fives || round) return;
    doubts_.push_back({"joint " + inQuotes(joint.name) + ": limits from " + text(joint.lower) +
                       " to " + text(joint.upper) + " rad: are they degrees?"});
  }

  const std::vector<Link>& links_;
  const std::vector<Joint>& joints_;
  const long double size_, travel_;
  std::vector<Doubt> doubts_;
};

}  // namespace

double largestPosition(const Joint& joint) {
  constexpr double kBeyond = 5;  // times the limit
  const bool limited = joint.type == JointType::kPrismatic || joint.type == JointType::kRevolute;
  if (!limited || !(joint.lower < joint.upper)) return std::numeric_limits<double>::infinity();
  return kBeyond * std::max(std::abs(joint.lower), std::abs(joint.upper));
}

std::string positionQuestion(const Joint& joint, double position) {
  const double limit = std::max(std::abs(joint.lower), std::abs(joint.upper));
  return "positions of " + inQuotes(joint.name) + " reach " + numberText(std::abs(position)) +
         ", its limit is " + numberText(limit) +
         (joint.type == JointType::kPrismatic ? " m: are they millimetres?"
                                              : " rad: are they degrees?");
}

std::vector<Doubt> unitDoubts(const std::vector<Link>& links, const std::vector<Joint>& joints) {
  return Judge(links, joints).judge();
}

}  // namespace virtual_work_dynamics
