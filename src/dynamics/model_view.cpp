#include "dynamics/model_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "loops/link_kinematics.h"
#include "virtual_work_dynamics/dynamics.h"

namespace virtual_work_dynamics {
namespace {

using Eigen::Vector3d;

constexpr double kStandardGravity = 9.80665;  // m/s^2
constexpr double kYaw = 0.8, kPitch = 0.35;   // rad
constexpr double kSame = 1e-6;                // directions that differ by less are the same
constexpr double kViewTurn =
    0.6;  // rad that joints of an open chain turn to either side, to be in view
constexpr double kCell = 0.2;  // of a grid, of the size
// A force below this part of the weight, a moment below this part of force times size, is nothing.
constexpr double kNegligible = 1e-9;
// What is small at the start by chance does not count as less than this part of the largest force
// times size, or the largest moment over size: motion would make its arrows gigantic.
constexpr double kLeastArm = 0.1;
// What counts as the arm of the largest force where there is no moment at all.
constexpr double kUsualArm = 0.5;

// The largest of 1, 2 and 5 times a power of ten that is not larger.
double roundDown(double value) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  return value >= 5 * power ? 5 * power : value >= 2 * power ? 2 * power : power;
}

// Texts: height, of the size; distance of lines and width of a letter, of the height.
constexpr double kTextHeight = 0.03, kLinePitch = 1.25, kLetterWidth = 0.43;
constexpr double kManyTexts = 10;  // of which on texts are smaller
constexpr double kLettersOfNumbers = 18;
constexpr std::array<int, 9> kPlaces{0, 1, -1, 2, -2, 3, -3, 4, -4};  // lines above
constexpr std::size_t kMostTexts = 200;  // of more, each would have to look at all others

class LinkPoints {
 public:
  LinkPoints(const Mechanism& mechanism, const Scene& scene)
      : mechanism_(mechanism), kinematics_(mechanism) {
    for (std::size_t i = 0; i < mechanism.links().size(); ++i) {
      links_.emplace(mechanism.links()[i].name, static_cast<int>(i));
    }
    for (std::size_t k = 0; k < mechanism.joints().size(); ++k) {
      if (mechanism.isInnerPart(static_cast<int>(k))) continue;
      pins_.emplace(mechanism.reactionName(static_cast<int>(k)),
                    std::pair(static_cast<int>(k) + 1, Vector3d::Zero()));
    }
    for (const Closure& closure : scene.closures) {
      pins_.emplace(closure.name, std::pair(links_.at(closure.child.link), closure.child.xyz));
    }
    pins_.emplace(kGround, std::pair(0, Vector3d::Zero()));
  }

  void setPosition(const Eigen::VectorXd& q) { kinematics_.setPosition(q); }

  void addTo(Eigen::AlignedBox3d& box, const Scene& scene) const {
    const auto add = [&box](const Vector3d& point) {
      if (point.allFinite()) box.extend(point);
    };
    for (std::size_t i = 0; i < mechanism_.links().size(); ++i) {
      const Link& link = mechanism_.links()[i];
      const int index = static_cast<int>(i);
      add(originOf(index));
      if (link.mass > 0) add(pointOf(index, link.p_KoCm_K.cast<double>()));
    }
    for (const Closure& closure : scene.closures) {
      add(pointOf(closure.parent.link, closure.parent.xyz));
      add(pointOf(closure.child.link, closure.child.xyz));
    }
    for (const PointSpring& spring : scene.springs) {
      add(pointOf(spring.link_a, spring.at_a));
      add(pointOf(spring.link_b, spring.at_b));
    }
    for (const AppliedWrench& wrench : scene.applied_wrenches) {
      add(pointOf(wrench.link, wrench.at));
    }
  }

  Vector3d pinOf(const std::string& reaction) const {
    const auto& [link, at] = pins_.at(reaction);
    return pointOf(link, at);
  }

  // The direction in which every joint turns, and across which every joint slides; zero: none.
  Vector3d normalOfPlane() const {
    Vector3d normal = Vector3d::Zero();
    for (std::size_t k = 0; k < mechanism_.joints().size(); ++k) {
      const Joint& joint = mechanism_.joints()[k];
      if (joint.type == JointType::kFixed || joint.type == JointType::kPrismatic) continue;
      const Vector3d& axis = kinematics_.axisOf(static_cast<int>(k));
      if (normal.isZero()) normal = axis;
      if (normal.cross(axis).norm() > kSame) return Vector3d::Zero();
    }
    for (std::size_t k = 0; k < mechanism_.joints().size(); ++k) {
      if (mechanism_.joints()[k].type != JointType::kPrismatic) continue;
      const Vector3d& axis = kinematics_.axisOf(static_cast<int>(k));
      if (std::abs(normal.dot(axis)) > kSame) return Vector3d::Zero();
    }
    return normal;
  }

 private:
  const Vector3d& originOf(int link) const { return kinematics_.originOf(link); }
  Vector3d pointOf(int link, const Vector3d& at) const {
    return originOf(link) + kinematics_.axesOf(link) * at;
  }
  Vector3d pointOf(const std::string& link, const Vector3d& at) const {
    return pointOf(links_.at(link), at);
  }

  const Mechanism& mechanism_;
  LinkKinematics kinematics_;
  std::unordered_map<std::string, int> links_;
  std::unordered_map<std::string, std::pair<int, Vector3d>> pins_;  // link, point on it
};

// The position with every turning joint at an angle, or at the limit next to it; sliding ones at
// zero.
Eigen::VectorXd turned(const Mechanism& mechanism, double angle) {
  Eigen::VectorXd q(static_cast<Eigen::Index>(mechanism.coordinates().size()));
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const Joint& joint = mechanism.jointOf(static_cast<int>(i));
    q[i] = unitOf(joint) == Unit::kRadian ? angle : 0;
    if (joint.lower < joint.upper) q[i] = std::clamp(q[i], joint.lower, joint.upper);
  }
  return q;
}

Eigen::VectorXd startOf(const Mechanism& mechanism, const Dynamics& dynamics) {
  return dynamics.closed() ? dynamics.assembly() : turned(mechanism, 0);
}

void setBox(const Mechanism& mechanism, const Scene& scene, const Eigen::VectorXd& start,
            bool closed, LinkPoints& points, ModelView& view) {
  if (!closed) {
    for (const double angle : {-kViewTurn, kViewTurn}) {
      points.setPosition(turned(mechanism, angle));
      points.addTo(view.box, scene);
    }
  }
  points.setPosition(start);
  points.addTo(view.box, scene);
  if (view.box.isEmpty()) view.box.extend(Vector3d::Zero());
  const double diagonal = view.box.diagonal().norm();
  if (diagonal > 0 && std::isfinite(diagonal)) view.size = diagonal;
}

struct Largest {
  double force = 0, torque = 0;  // N, N m
};

Largest largestOf(const Dynamics& dynamics, const Motion& motion, Dynamics::Workspace& workspace) {
  dynamics.compute(motion, workspace);
  Largest largest;
  if (!workspace.results().finite()) return largest;
  for (const Wrench& wrench : workspace.results().child_axes) {
    largest.force = std::max(largest.force, wrench.force.norm());
    largest.torque = std::max(largest.torque, wrench.torque.norm());
  }
  return largest;
}

double weightOf(const Mechanism& mechanism) {
  long double mass = 0;
  for (const Link& link : mechanism.links()) mass += link.mass;
  const double weight = static_cast<double>(mass) * kStandardGravity;
  return std::isfinite(weight) ? weight : 0;
}

Largest referenceOf(const Mechanism& mechanism, const Dynamics& dynamics, Motion& motion,
                    double size) {
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  const double weight = weightOf(mechanism);
  const auto isNothing = [&](const Largest& largest) {
    return !(std::max(largest.force, largest.torque / size) > kNegligible * weight);
  };
  Largest reference = largestOf(dynamics, motion, workspace);
  if (isNothing(reference)) {
    for (Eigen::Index i = 0; i < motion.qdd.size(); ++i) {
      motion.qdd[i] = dynamics.actuated()[static_cast<std::size_t>(i)] ? 1 : 0;
    }
    if (dynamics.complete(motion, workspace)) reference = largestOf(dynamics, motion, workspace);
  }
  if (isNothing(reference)) reference.force = weight > 0 ? weight : 1;
  return reference;
}

void setScales(const Largest& reference, ModelView& view) {
  const double from_torque = reference.torque / view.size;
  const bool pulls = reference.force > kNegligible * from_torque;
  const double force = pulls ? std::max(reference.force, kLeastArm * from_torque) : from_torque;
  const bool turns = reference.torque > kNegligible * force * view.size;
  const double torque = turns ? std::max(reference.torque, kLeastArm * force * view.size)
                              : kUsualArm * force * view.size;
  view.force_scale = ModelView::kArrow * view.size / force;
  view.torque_scale = ModelView::kArrow * view.size / torque;
  view.legend_force = roundDown(force);
  view.legend_torque = roundDown(torque);
  view.cell = roundDown(kCell * view.size);
}

void lookFromAbove(double turn, ModelView& view) {
  view.from_above = true;
  view.turn = turn;
  view.right = Vector3d(std::cos(turn), std::sin(turn), 0);
  view.up = Vector3d(-std::sin(turn), std::cos(turn), 0);
}

// Along the axes of a planar mechanism, or else from an angle; upright as gravity says.
void setCamera(const Vector3d& gravity, const Vector3d& normal, ModelView& view) {
  const double across = std::hypot(gravity.x(), gravity.y());
  const bool lies = across > std::abs(gravity.z());
  if (lies || std::abs(normal.z()) > 1 - kSame) {
    lookFromAbove(lies ? std::atan2(gravity.x(), -gravity.y()) : 0, view);
    return;
  }
  const bool sideways = !normal.isZero() && std::abs(normal.z()) < kSame;
  view.upside_down = gravity.z() > 0;
  // Along an axis the camera stands on the side of -y or +x, from where x or y point to the right.
  const bool turned = normal.y() > kSame || (normal.y() > -kSame && normal.x() < 0);
  const Vector3d side = turned ? Vector3d(-normal) : normal;
  view.yaw = sideways ? std::atan2(side.y(), side.x()) : kYaw;
  view.pitch = sideways ? 0 : kPitch;
  const Vector3d back(std::cos(view.yaw) * std::cos(view.pitch),
                      std::sin(view.yaw) * std::cos(view.pitch), std::sin(view.pitch));
  view.right = Vector3d::UnitZ().cross(back).normalized() * (view.upside_down ? -1 : 1);
  view.up = back.cross(view.right);
}

// Moves texts up or down, by as few lines as free them of those before.
void setTexts(const LinkPoints& points, const std::vector<std::string>& reactions,
              ModelView& view) {
  const double line = kLinePitch * view.text_height;
  struct Text {
    double x, y, width;
  };
  std::vector<Text> texts;
  const auto isFree = [&](const Text& text) {
    return std::none_of(texts.begin(), texts.end(), [&](const Text& other) {
      return std::abs(text.x - other.x) < (text.width + other.width) / 2 &&
             std::abs(text.y - other.y) < 0.9 * line;
    });
  };
  for (const std::string& reaction : reactions) {
    int place = 0;
    if (reactions.size() <= kMostTexts) {
      const Vector3d point = points.pinOf(reaction);
      const double letters = static_cast<double>(reaction.size()) + kLettersOfNumbers;
      Text text{point.dot(view.right), 0, kLetterWidth * letters * view.text_height};
      const auto isTaken = [&](int lines) {
        text.y = point.dot(view.up) + lines * line;
        return !isFree(text);
      };
      const auto found = std::find_if_not(kPlaces.begin(), kPlaces.end(), isTaken);
      if (found != kPlaces.end()) place = *found;
      text.y = point.dot(view.up) + place * line;
      texts.push_back(text);
    }
    view.text_lines.push_back(place);
  }
}

}  // namespace

ModelView modelView(const Mechanism& mechanism, const Scene& scene,
                    const std::vector<std::string>& reactions) {
  Scene moving = scene;
  moving.static_motion = false;
  Request request;
  request.efforts = false;
  request.child_axes = reactions;
  request.child_axes_about_origin = true;  // where arrows are drawn
  const Dynamics dynamics(mechanism, moving, request);
  Motion motion(dynamics.coordinates());
  motion.q = startOf(mechanism, dynamics);

  ModelView view;
  LinkPoints points(mechanism, scene);
  setBox(mechanism, scene, motion.q, dynamics.closed(), points, view);
  setScales(referenceOf(mechanism, dynamics, motion, view.size), view);
  setCamera(scene.gravity, points.normalOfPlane(), view);
  const double crowd = static_cast<double>(reactions.size()) / kManyTexts;
  view.text_height = kTextHeight * view.size / std::clamp(std::sqrt(crowd), 1.0, 1.5);
  setTexts(points, reactions, view);
  return view;
}

}  // namespace virtual_work_dynamics
