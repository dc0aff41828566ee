#pragma once

#include "description.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// The same mechanism, scene and motion in other units of length and mass, of which a metre has
/// `length` and a kilogram `mass`; the unit of time is the second.
struct ChangedUnits {
  double length = 1, mass = 1;

  double force() const { return mass * length; }
  double torque() const { return mass * length * length; }

  Mechanism of(const Mechanism& mechanism) const {
    Description tree(mechanism);
    for (Link& link : tree.links) {
      link.mass *= mass;
      link.p_KoCm_K *= length;
      link.inertia_Cm_K *= torque();
    }
    for (Joint& joint : tree.joints) {
      joint.p_PoKo_P *= length;
      if (joint.type == JointType::kPrismatic) joint.offset *= length;
      if (!joint.mimics) continue;
      const Joint& master = tree.joints[static_cast<std::size_t>(joint.coordinate)];
      joint.multiplier *= wayOf(joint) / wayOf(master);
    }
    return tree.arranged();
  }

  Scene of(const Mechanism& mechanism, Scene scene) const {
    scene.gravity *= length;
    for (AppliedWrench& applied : scene.applied_wrenches) {
      applied.at *= length;
      applied.force *= force();
      applied.torque *= torque();
    }
    for (Payload& payload : scene.payloads) {
      payload.mass *= mass;
      payload.at *= length;
      payload.inertia *= torque();
    }
    for (JointTerms& terms : scene.joints) change(mechanism, terms);
    for (Closure& closure : scene.closures) change(closure);
    for (PointSpring& spring : scene.springs) {
      spring.at_a *= length;
      spring.at_b *= length;
      spring.rest_length *= length;
      spring.stiffness *= mass;
      spring.damping *= mass;
    }
    for (Coupling& coupling : scene.couplings) {
      const double whole = wayOf(jointOf(mechanism, coupling.terms.front().name));
      for (NamedNumber& term : coupling.terms) {
        term.value *= whole / wayOf(jointOf(mechanism, term.name));
      }
    }
    for (NamedNumber& start : scene.assembly) {
      start.value *= wayOf(jointOf(mechanism, start.name));
    }
    if (scene.redundancy.length) *scene.redundancy.length *= length;
    return scene;
  }

  Motion of(const Mechanism& mechanism, Motion motion) const {
    for (Eigen::Index i = 0; i < motion.q.size(); ++i) {
      const double way = mechanism.unitOf(static_cast<int>(i)) == Unit::kMetre ? length : 1;
      for (Eigen::VectorXd* rates : {&motion.q, &motion.qd, &motion.qdd}) (*rates)[i] *= way;
    }
    motion.root.position *= length;
    motion.root.velocity *= length;
    motion.root.acceleration *= length;
    return motion;
  }

 private:
  double wayOf(const Joint& joint) const {
    return joint.type == JointType::kPrismatic ? length : 1;
  }

  static const Joint& jointOf(const Mechanism& mechanism, const std::string& name) {
    return mechanism.joint(mechanism.jointIndex(name));
  }

  void change(const Mechanism& mechanism, JointTerms& terms) const {
    const bool slides = jointOf(mechanism, terms.joint).type == JointType::kPrismatic;
    const double effort = slides ? force() : torque(), per_way = slides ? mass : torque();
    const double way = slides ? length : 1;
    terms.stiffness *= per_way;
    if (terms.damping) *terms.damping *= per_way;
    terms.rotor_inertia *= per_way;
    if (terms.coulomb) *terms.coulomb *= effort;
    terms.offset *= effort;
    terms.rest *= way;
    terms.coulomb_velocity *= way;
  }

  void change(Closure& closure) const {
    closure.parent.xyz *= length;
    closure.child.xyz *= length;
    if (closure.length) *closure.length *= length;
    closure.touch.radius *= length;
    closure.touch.tube_radius *= length;
    closure.teeth.parent_radius *= length;
    closure.teeth.child_radius *= length;
  }
};

}  // namespace virtual_work_dynamics
