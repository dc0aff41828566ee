#pragma once

#include <Eigen/Dense>
#include <map>
#include <string>
#include <vector>

#include "virtual_work_dynamics/free_turn.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// A quantity of time at one instant, with its first and second derivatives.
template <typename M>
struct Motion2 {
  M value = M::Zero(), rate = M::Zero(), acceleration = M::Zero();

  template <typename N>
  auto operator*(const Motion2<N>& b) const {
    using Product = Eigen::Matrix<long double, M::RowsAtCompileTime, N::ColsAtCompileTime>;
    return Motion2<Product>{value * b.value, rate * b.value + value * b.rate,
                            acceleration * b.value + 2 * rate * b.rate + value * b.acceleration};
  }
  Motion2 operator+(const Motion2& b) const {
    return {value + b.value, rate + b.rate, acceleration + b.acceleration};
  }
};

/// Newton's and Euler's equations in inertial axes and long double for trees whose joints have
/// several freedoms. Joints are those of the description, each with the pose of its child link as a
/// closed form of all its freedoms, differentiated twice by the product rule: no chains of joints
/// of one freedom, and no formula of relative velocities. Of the mechanism under test only the
/// names and order of coordinates are read. Scenes have no joint terms.
class CompoundOracle {
 public:
  struct Wrench {
    Vector3l force = Vector3l::Zero(), torque = Vector3l::Zero();
  };

  /// @param turns of joints that turn freely, by name
  CompoundOracle(const Mechanism& described, const Mechanism& tested, const Scene& scene,
                 const Motion& motion, const std::map<std::string, FreeTurn>& turns = {})
      : described_(described), scene_(scene), turns_(turns), links_(described.links().size()) {
    for (std::size_t i = 0; i < tested.coordinateNames().size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      const bool rests = scene.static_motion;
      coordinates_[tested.coordinateNames()[i]] = {motion.q[at], rests ? 0.0L : motion.qd[at],
                                                   rests ? 0.0L : motion.qdd[at]};
    }
    for (const JointTypeEntry& entry : scene.joint_types) types_[entry.joint] = &entry;
    links_[0].R.value.setIdentity();
    freedoms_.resize(described.joints().size());
    for (std::size_t k = 0; k < described.joints().size(); ++k) move(k);
    for (std::size_t i = 0; i < links_.size(); ++i) load(i);
    for (std::size_t i = links_.size(); i-- > 1;) {
      const int parent = described.joint(static_cast<int>(i) - 1).parent_link;
      Link& own = links_[i];
      Link& carrier = links_[static_cast<std::size_t>(parent)];
      carrier.wrench.force += own.wrench.force;
      carrier.wrench.torque +=
          own.wrench.torque + (own.o.value - carrier.o.value).cross(own.wrench.force);
    }
  }

  /// The wrench of the parent on the child about the child's origin, root axes; joint -1: ground.
  Wrench reaction(int joint) const {
    const Link& link = links_[static_cast<std::size_t>(joint + 1)];
    if (scene_.include_active || joint < 0) return link.wrench;
    return borne(freedoms_[static_cast<std::size_t>(joint)], link.wrench);
  }
  Wrench childReaction(int joint) const {
    const Matrix3l& R = links_[static_cast<std::size_t>(joint + 1)].R.value;
    const Wrench wrench = reaction(joint);
    return {R.transpose() * wrench.force, R.transpose() * wrench.torque};
  }

  /// Effort by the name of the coordinate.
  std::map<std::string, long double> efforts() const {
    std::map<std::string, long double> efforts;
    for (std::size_t k = 0; k < freedoms_.size(); ++k) {
      for (const Freedom& freedom : freedoms_[k]) {
        efforts[freedom.name] += freedom.multiplier * work(freedom, links_[k + 1].wrench);
      }
    }
    return efforts;
  }

 private:
  using Scalar = Eigen::Matrix<long double, 1, 1>;
  using Rotation = Motion2<Matrix3l>;
  using Point = Motion2<Vector3l>;
  /// What a freedom moves the child by: its turn and the displacement of its origin, root axes.
  struct Freedom {
    std::string name;
    Vector3l turn = Vector3l::Zero(), slide = Vector3l::Zero();
    long double multiplier = 1;
  };
  struct Link {
    Rotation R;
    Point o;
    Wrench wrench;  // about o
  };
  struct Coordinate {
    long double q = 0, qd = 0, qdd = 0;
  };

  static Matrix3l tilde(const Vector3l& v) {
    Matrix3l m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
  }
  static Vector3l untilde(const Matrix3l& m) { return {m(2, 1), m(0, 2), m(1, 0)}; }

  static Rotation turnAbout(const Vector3l& axis, const Coordinate& c) {
    const Matrix3l U = tilde(axis);
    const Matrix3l R = Matrix3l::Identity() + std::sin(c.q) * U + (1 - std::cos(c.q)) * U * U;
    return {R, c.qd * U * R, (c.qdd * U + c.qd * c.qd * U * U) * R};
  }
  static Point slideAlong(const Vector3l& axis, const Coordinate& c) {
    return {c.q * axis, c.qd * axis, c.qdd * axis};
  }
  template <typename M>
  static Motion2<M> constant(const M& value) {
    Motion2<M> result;
    result.value = value;
    return result;
  }

  Coordinate at(const std::string& name) const { return coordinates_.at(name); }

  // The pose of the child in the joint's frame, and the freedoms there.
  void relative(const Joint& joint, Rotation& R, Point& p, std::vector<Freedom>& freedoms) const {
    R.value.setIdentity();
    const auto entry = types_.find(joint.name);
    if (entry == types_.end()) {
      if (joint.type == JointType::kFixed) return;
      const std::string& name = described_.jointOf(joint.coordinate).name;
      const Coordinate c = at(name);
      const long double m = joint.multiplier;
      const Coordinate own{m * c.q + joint.offset, m * c.qd, m * c.qdd};
      Freedom freedom;
      freedom.name = name;
      freedom.multiplier = m;
      if (joint.type == JointType::kPrismatic) {
        p = slideAlong(joint.axis_K, own);
        freedom.slide = joint.axis_K;
      } else {
        R = turnAbout(joint.axis_K, own);
        freedom.turn = joint.axis_K;
      }
      freedoms.push_back(freedom);
      return;
    }
    relativeOf(*entry->second, joint, R, p, freedoms);
  }

  void relativeOf(const JointTypeEntry& entry, const Joint& joint, Rotation& R, Point& p,
                  std::vector<Freedom>& freedoms) const {
    // Of joints that turn freely there is none.
    const Vector3l u =
        entry.axis ? Vector3l(entry.axis->cast<long double>().normalized()) : joint.axis_K;
    const std::string& n = joint.name;
    const Vector3l none = Vector3l::Zero();
    switch (entry.type) {
      case CompoundType::kPlanar: {
        Vector3l x;
        int only = -1;
        for (int i = 0; i < 3; ++i) {
          if (std::abs(u[i]) == 1) only = i;
        }
        if (only >= 0) {
          x = Vector3l::Unit((only + 1) % 3);
        } else {
          int least = 0;
          u.cwiseAbs().minCoeff(&least);
          x = Vector3l::Unit(least).cross(u).normalized();
        }
        const Vector3l y = u.cross(x);
        p = slideAlong(x, at(n + ".x")) + slideAlong(y, at(n + ".y"));
        R = turnAbout(u, at(n + ".angle"));
        freedoms = {{n + ".x", none, x}, {n + ".y", none, y}, {n + ".angle", u, none}};
        return;
      }
      case CompoundType::kCylindrical:
        p = slideAlong(u, at(n + ".slide"));
        R = turnAbout(u, at(n + ".angle"));
        freedoms = {{n + ".slide", none, u}, {n + ".angle", u, none}};
        return;
      case CompoundType::kUniversal: {
        const Vector3l v = entry.axis2->cast<long double>().normalized();
        const Rotation first = turnAbout(u, at(n + ".angle1"));
        R = first * turnAbout(v, at(n + ".angle2"));
        freedoms = {{n + ".angle1", u, none}, {n + ".angle2", first.value * v, none}};
        return;
      }
      case CompoundType::kFloating:
        for (int i = 0; i < 3; ++i) {
          static const char* const kSlides[] = {".x", ".y", ".z"};
          p = p + slideAlong(Vector3l::Unit(i), at(n + kSlides[i]));
          freedoms.push_back({n + kSlides[i], none, Vector3l::Unit(i)});
        }
        [[fallthrough]];
      case CompoundType::kSpherical: {
        static const char* const kTurns[] = {".rx", ".ry", ".rz"};
        const FreeTurn& turn = turns_.at(n);
        const bool rests = scene_.static_motion;
        const Vector3l w = rests ? none : Vector3l(turn.angular_velocity.cast<long double>());
        const Vector3l e = rests ? none : Vector3l(turn.angular_acceleration.cast<long double>());
        const Matrix3l Q = turn.orientation.cast<long double>().normalized().toRotationMatrix();
        R = {Q, Q * tilde(w), Q * (tilde(e) + tilde(w) * tilde(w))};
        for (int i = 0; i < 3; ++i) freedoms.push_back({n + kTurns[i], Q.col(i), none});
        return;
      }
      case CompoundType::kScrew: {
        const long double lead = *entry.pitch / (2 * std::acos(-1.0L));
        const Coordinate c = at(n);
        p = slideAlong(u, {lead * c.q, lead * c.qd, lead * c.qdd});
        R = turnAbout(u, c);
        freedoms = {{n, u, lead * u}};
        return;
      }
    }
  }

  void move(std::size_t k) {
    const Joint& joint = described_.joint(static_cast<int>(k));
    const Link& parent = links_[static_cast<std::size_t>(joint.parent_link)];
    Rotation R;
    Point p;
    relative(joint, R, p, freedoms_[k]);
    const Rotation frame = parent.R * constant(joint.R_PK);
    links_[k + 1].R = frame * R;
    links_[k + 1].o = parent.o + parent.R * constant(joint.p_PoKo_P) + frame * p;
    for (Freedom& freedom : freedoms_[k]) {
      freedom.turn = frame.value * freedom.turn;
      freedom.slide = frame.value * freedom.slide;
    }
  }

  // What all joints of a link together exert on it, about its origin.
  void load(std::size_t i) {
    Link& own = links_[i];
    const auto& link = described_.link(static_cast<int>(i));
    const Point c = own.o + own.R * constant(link.p_KoCm_K);
    const Matrix3l& R = own.R.value;
    // The moment of momentum R I R^T w with w~ = R' R^T, differentiated.
    const Matrix3l w_tilde = own.R.rate * R.transpose();
    const Matrix3l alpha_tilde =
        own.R.acceleration * R.transpose() + own.R.rate * own.R.rate.transpose();
    const Vector3l w = untilde(w_tilde), alpha = untilde(alpha_tilde);
    const Matrix3l I = R * link.inertia_Cm_K * R.transpose();
    Vector3l force = link.mass * (c.acceleration - scene_.gravity.cast<long double>());
    Vector3l moment = I * alpha + w.cross(I * w) + (c.value - own.o.value).cross(force);
    for (const AppliedWrench& applied : scene_.applied_wrenches) {
      if (applied.link != link.name) continue;
      const Matrix3l axes = applied.axes == Axes::kRoot ? Matrix3l(Matrix3l::Identity()) : R;
      const Vector3l f = axes * applied.force.cast<long double>();
      force -= f;
      moment -= axes * applied.torque.cast<long double>() +
                Vector3l(R * applied.at.cast<long double>()).cross(f);
    }
    own.wrench = {force, moment};
  }

  static long double work(const Freedom& freedom, const Wrench& wrench) {
    return freedom.turn.dot(wrench.torque) + freedom.slide.dot(wrench.force);
  }

  // Takes away forces along slides and moments about turns so that what is left does no work.
  static Wrench borne(const std::vector<Freedom>& freedoms, Wrench wrench) {
    const auto n = static_cast<Eigen::Index>(freedoms.size());
    if (n == 0) return wrench;
    Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic> works(n, n);
    Eigen::Matrix<long double, Eigen::Dynamic, 1> efforts(n);
    std::vector<Wrench> actives;
    for (const Freedom& freedom : freedoms) {
      const bool turns = !freedom.turn.isZero(0);
      actives.push_back({turns ? Vector3l(Vector3l::Zero()) : freedom.slide,
                         turns ? freedom.turn : Vector3l(Vector3l::Zero())});
    }
    for (Eigen::Index i = 0; i < n; ++i) {
      const Freedom& freedom = freedoms[static_cast<std::size_t>(i)];
      efforts[i] = work(freedom, wrench);
      for (Eigen::Index j = 0; j < n; ++j) {
        works(i, j) = work(freedom, actives[static_cast<std::size_t>(j)]);
      }
    }
    const auto shares = works.partialPivLu().solve(efforts).eval();
    for (Eigen::Index j = 0; j < n; ++j) {
      wrench.force -= shares[j] * actives[static_cast<std::size_t>(j)].force;
      wrench.torque -= shares[j] * actives[static_cast<std::size_t>(j)].torque;
    }
    return wrench;
  }

  const Mechanism& described_;
  const Scene& scene_;
  const std::map<std::string, FreeTurn> turns_;
  std::map<std::string, Coordinate> coordinates_;
  std::map<std::string, const JointTypeEntry*> types_;
  std::vector<std::vector<Freedom>> freedoms_;  // by joint
  std::vector<Link> links_;
};

}  // namespace virtual_work_dynamics
