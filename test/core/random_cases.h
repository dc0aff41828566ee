#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "description.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// An input of the inverse dynamics: a mechanism, a scene and a state.
struct Case {
  Mechanism mechanism;
  Scene scene;
  Motion motion;
};

/// Random trees, scenes and states. All numbers are doubles or, for orientations, made from
/// doubles, so that a description can hold them. The same seed gives the same case.
class RandomCases {
 public:
  explicit RandomCases(unsigned seed) : generator_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }
  int pick(int count) { return std::uniform_int_distribution<int>(0, count - 1)(generator_); }
  bool chance(double probability) { return uniform(0, 1) < probability; }
  Vector3l vector(double size) {
    const double x = uniform(-size, size), y = uniform(-size, size);
    return {x, y, uniform(-size, size)};
  }
  Eigen::Vector3d doubles(double size) { return vector(size).cast<double>(); }
  Matrix3l rotation() { return rotationOf(uniform(-3, 3), uniform(-1.4, 1.4), uniform(-3, 3)); }

  /// A tree of 1 to 12 links, or of `links`, in a random scene and state.
  Case next(int links = 0) {
    Mechanism tree = mechanism(links > 0 ? links : 1 + pick(12));
    Scene wanted = scene(tree);
    Motion state = motion(tree);
    return {std::move(tree), std::move(wanted), std::move(state)};
  }

  /// A name that sorts anywhere among other names; `serial` makes it different from them.
  std::string name(int serial) {
    return std::string(1, static_cast<char>('a' + pick(26))) + std::to_string(pick(100)) + "_" +
           std::to_string(serial);
  }

  Mechanism mechanism(int links) {
    Description tree;
    for (int i = 0; i < links; ++i) tree.links.push_back(link(i));
    const int shape = pick(4);
    const double fixed = uniform(0, 0.4);
    for (int i = 1; i < links; ++i) {
      Joint next = joint(i, fixed);
      next.parent_link = shape == 0 ? i - 1 : (shape == 1 ? 0 : pick(i));
      tree.joints.push_back(next);
    }
    if (chance(0.5)) addMimics(tree);
    return tree.arranged();
  }

  Scene scene(const Mechanism& mechanism) {
    Scene scene;
    const int gravity = pick(4);
    if (gravity == 0) scene.gravity.setZero();
    if (gravity > 1) scene.gravity = doubles(10);
    scene.static_motion = chance(0.2);
    scene.include_active = chance(0.75);
    const int reactions = pick(5);
    if (reactions == 0) scene.reactions = ReactionSelection::kNone;
    if (reactions > 2) nameReactions(mechanism, scene);
    for (int wrenches = pick(4); wrenches > 0; --wrenches) {
      scene.applied_wrenches.push_back(appliedWrench(mechanism));
    }
    if (chance(0.4)) addJointTerms(mechanism, scene);
    scene.use_urdf_dynamics = chance(0.3);
    return scene;
  }

  AppliedWrench appliedWrench(const Mechanism& mechanism) {
    AppliedWrench applied;
    applied.link = mechanism.links()[pick(static_cast<int>(mechanism.links().size()))].name;
    applied.axes = chance(0.5) ? Axes::kLink : Axes::kRoot;
    if (chance(0.7)) applied.at = doubles(0.5);
    if (chance(0.8)) applied.force = doubles(20);
    if (chance(0.6)) applied.torque = doubles(5);
    return applied;
  }

  /// A random motion, in which velocities, accelerations or single entries of them may be zero.
  Motion motion(const Mechanism& mechanism) {
    Motion motion(static_cast<Eigen::Index>(mechanism.coordinates().size()));
    const bool moves = chance(0.9), accelerates = chance(0.9);
    for (Eigen::Index i = 0; i < motion.q.size(); ++i) {
      if (chance(0.9)) motion.q[i] = uniform(-3, 3);
      if (moves && chance(0.9)) motion.qd[i] = uniform(-4, 4);
      if (accelerates && chance(0.9)) motion.qdd[i] = uniform(-10, 10);
    }
    return motion;
  }

 private:
  static Matrix3l rotationOf(double roll, double pitch, double yaw) {
    using Turn = Eigen::AngleAxis<long double>;
    return (Turn(yaw, Vector3l::UnitZ()) * Turn(pitch, Vector3l::UnitY()) *
            Turn(roll, Vector3l::UnitX()))
        .toRotationMatrix();
  }

  // A random link: one in eight is massless, one in eight is a point, one in eight is a rod.
  Link link(int index) {
    Link link;
    link.name = name(index);
    const int kind = pick(8);
    if (kind == 0) return link;
    link.mass = uniform(0.05, 5);
    if (chance(0.8)) link.p_KoCm_K = vector(0.3);
    if (kind == 1) return link;
    const double a = uniform(0.01, 0.3), b = uniform(0.01, 0.3), c = uniform(0.01, 0.3);
    Vector3l moments{b * b + c * c, a * a + c * c, a * a + b * b};
    if (kind == 2) moments = {0, a * a, a * a};
    moments *= link.mass / 12;
    const Matrix3l R = chance(0.7) ? rotation() : Matrix3l(Matrix3l::Identity());
    const Matrix3l inertia = R * moments.asDiagonal() * R.transpose();
    const Matrix3l symmetric = (inertia + inertia.transpose()) / 2;
    link.inertia_Cm_K = symmetric.cast<double>().cast<long double>();
    return link;
  }

  Joint joint(int index, double fixed) {
    static const JointType kTypes[] = {JointType::kRevolute, JointType::kContinuous,
                                       JointType::kRevolute, JointType::kPrismatic};
    Joint joint;
    joint.name = name(index);
    joint.type = chance(fixed) ? JointType::kFixed : kTypes[pick(4)];
    joint.child_link = index;
    const int offset = pick(5);
    if (offset == 0) joint.p_PoKo_P[pick(3)] = uniform(-0.5, 0.5);
    if (offset > 1) joint.p_PoKo_P = vector(0.5);
    const int turn = pick(3);
    if (turn == 0) joint.R_PK = rotationOf(pick(4) * M_PI_2, 0, pick(4) * M_PI_2);
    if (turn == 1) joint.R_PK = rotation();
    if (joint.type == JointType::kFixed) return joint;
    if (chance(0.3)) joint.damping = uniform(0, 10);
    if (chance(0.3)) joint.friction = uniform(0, 10);
    if (chance(0.5)) {
      joint.axis_K[pick(3)] = chance(0.5) ? 1 : -1;
    } else {
      const Vector3l oblique = vector(1).normalized();
      joint.axis_K = oblique.cast<double>().cast<long double>().normalized();
    }
    return joint;
  }

  // Makes some joints mimic others, which move and mimic no joint themselves.
  void addMimics(Description& tree) {
    for (std::size_t k = 0; k < tree.joints.size(); ++k) {
      const int master = pick(static_cast<int>(tree.joints.size()));
      const bool fits = tree.joints[master].type != JointType::kFixed &&
                        !tree.joints[master].mimics && master != static_cast<int>(k) &&
                        !hasMimics(tree, static_cast<int>(k));
      Joint& joint = tree.joints[k];
      if (!fits || joint.type == JointType::kFixed || !chance(0.4)) continue;
      joint.mimics = true;
      joint.coordinate = master;
      joint.multiplier = chance(0.2) ? -1 : uniform(-2, 2);
      if (chance(0.7)) joint.offset = uniform(-1, 1);
    }
  }

  static bool hasMimics(const Description& tree, int master) {
    return std::any_of(tree.joints.begin(), tree.joints.end(), [&](const Joint& joint) {
      return joint.mimics && joint.coordinate == master;
    });
  }

  void nameReactions(const Mechanism& mechanism, Scene& scene) {
    scene.reactions = ReactionSelection::kNamed;
    if (chance(0.5)) scene.reaction_names.emplace_back(kGround);
    for (const Joint& joint : mechanism.joints()) {
      if (chance(0.5)) scene.reaction_names.push_back(joint.name);
    }
  }

  void addJointTerms(const Mechanism& mechanism, Scene& scene) {
    for (const Joint& joint : mechanism.joints()) {
      if (joint.type == JointType::kFixed || chance(0.5)) continue;
      JointTerms terms;
      terms.joint = joint.name;
      if (chance(0.5)) terms.stiffness = uniform(0, 100);
      if (chance(0.5)) terms.rest = uniform(-1, 1);
      if (chance(0.5)) terms.damping = uniform(0, 10);
      if (chance(0.5)) terms.coulomb = uniform(0, 10);
      if (chance(0.5)) terms.coulomb_velocity = uniform(1e-3, 1);
      if (chance(0.5)) terms.rotor_inertia = uniform(0, 1);
      terms.offset = 20 * terms.rest;  // no draw of its own: all cases stay what they were
      scene.joints.push_back(terms);
    }
  }

  std::mt19937 generator_;
};

}  // namespace virtual_work_dynamics
