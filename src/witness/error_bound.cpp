#include "virtual_work_dynamics/error_bound.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "scene/input_checks.h"
#include "scene/joint_terms.h"
#include "scene/payloads.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

// Norms of a joint's constants, rounded once.
struct JointNorms {
  int parent_link = 0;
  int coordinate = -1;
  bool slides = false;
  double multiplier = 0;
  double offset = 0;
  double distance = 0;  // |p_PoKo|
};

// Norms of a link's constants.
struct LinkNorms {
  double mass = 0;
  double first = 0;   // m |r_C|
  double second = 0;  // norm of the inertia about the link's origin
  WrenchMagnitude applied;
};

// Norms of an applied wrench, whose values a load replaces.
struct AppliedNorms {
  std::size_t link = 0;
  long double arm = 0;
  WrenchMagnitude value;  // about the link's origin

  void set(const Eigen::Vector3d& force, const Eigen::Vector3d& torque) {
    const long double f = force.cast<long double>().norm();
    const long double t = torque.cast<long double>().norm();
    value = {static_cast<double>(f), static_cast<double>(t + arm * f)};
  }
};

// Sums of the norms of all terms of a link's angular velocity and accelerations.
struct MotionSums {
  double w = 0;
  double alpha = 0;
  double gamma = 0;

  double gradient() const { return w * w + alpha; }  // bounds U = w~ w~ + alpha~
};

JointNorms normsOf(const Joint& joint) {
  return {joint.parent_link,
          joint.coordinate,
          joint.type == JointType::kPrismatic,
          std::abs(joint.multiplier),
          std::abs(joint.offset),
          static_cast<double>(joint.p_PoKo_P.norm())};
}

LinkNorms normsOf(const Link& link) {
  const long double arm = link.p_KoCm_K.norm();
  // Frobenius' norm is no smaller than the spectral norm, and needs no eigenvalues.
  return {static_cast<double>(link.mass),
          static_cast<double>(link.mass * arm),
          static_cast<double>(link.inertia_Cm_K.norm() + link.mass * arm * arm),
          {}};
}

int ceilLog2(int count) {
  int result = 0;
  while ((1 << result) < count) ++result;
  return result;
}

}  // namespace

struct ErrorBound::Impl {
  Impl(const Mechanism& mechanism, const Scene& scene)
      : rests(scene.static_motion),
        root_moves(scene.root_moves),
        gravity(static_cast<double>(scene.gravity.cast<long double>().norm())),
        own_load(scene),
        terms(resolveJointTerms(mechanism, scene)),
        motions(mechanism.links().size()),
        slides(mechanism.joints().size()),
        wrenches(mechanism.links().size()),
        depths(mechanism.links().size()),
        efforts(mechanism.coordinates().size()),
        effort_depths(mechanism.coordinates().size()) {
    for (const Joint& joint : mechanism.joints()) joints.push_back(normsOf(joint));
    for (const Link& link : mechanism.links()) links.push_back(normsOf(link));
    for (std::size_t i = 0; i < scene.applied_wrenches.size(); ++i) {
      AppliedNorms norms;
      norms.link = static_cast<std::size_t>(linkOf(mechanism, scene, i));
      norms.arm = scene.applied_wrenches[i].at.cast<long double>().norm();
      applied_wrenches.push_back(norms);
    }
    motions[0].gamma = gravity;
    measureDepths();
  }

  void measureDepths() {
    std::vector<int> children(links.size(), 0), deepest(links.size(), 0), before(links.size(), 0);
    for (std::size_t k = 0; k < joints.size(); ++k) {
      const int parent = joints[k].parent_link;
      ++children[parent];
      before[k + 1] = parent == 0 ? 0 : before[parent] + 1;
    }
    for (std::size_t i = links.size(); i-- > 0;) {
      const int within = 1 + ceilLog2(children[i]) + deepest[i];
      depths[i] = before[i] + within;
      if (i == 0) break;
      const JointNorms& joint = joints[i - 1];
      deepest[joint.parent_link] = std::max(deepest[joint.parent_link], within);
      if (joint.coordinate < 0) continue;
      int& effort = effort_depths[joint.coordinate];
      effort = std::max(effort, depths[i]);
    }
  }

  void takeRoot(const RootMotion& root) {
    motions[0] = {root.angular_velocity.norm(), root.angular_acceleration.norm(),
                  gravity + root.acceleration.norm()};
  }

  double position(const JointNorms& joint, const Motion& motion) const {
    return joint.multiplier * std::abs(motion.q[joint.coordinate]) + joint.offset;
  }
  double rate(const JointNorms& joint, const Motion& motion) const {
    return rests ? 0 : joint.multiplier * std::abs(motion.qd[joint.coordinate]);
  }
  double acceleration(const JointNorms& joint, const Motion& motion) const {
    return rests ? 0 : joint.multiplier * std::abs(motion.qdd[joint.coordinate]);
  }

  double counted(double magnitude) const { return std::max(magnitude, least); }

  double gradient(const MotionSums& motion) const { return counted(motion.gradient()); }

  // Norms of (2.5) and (2.7).
  void move(std::size_t k, const Motion& motion) {
    const JointNorms& joint = joints[k];
    const MotionSums& parent = motions[joint.parent_link];
    MotionSums& link = motions[k + 1];
    slides[k] = joint.slides ? position(joint, motion) : 0;
    link = parent;
    link.gamma += gradient(parent) * counted(joint.distance + slides[k]);  // (2.7), |U_p| |r|
    if (joint.coordinate < 0) return;
    const double qd = rate(joint, motion), qdd = acceleration(joint, motion);
    if (joint.slides) {
      link.gamma += qdd + 2 * qd * parent.w;  // (2.7)
    } else {
      link.w += qd;                       // (2.5)
      link.alpha += qdd + qd * parent.w;  // (2.7)
    }
  }

  void addApplied() {
    for (LinkNorms& link : links) link.applied = {};
    for (const AppliedNorms& applied : applied_wrenches) {
      WrenchMagnitude& sum = links[applied.link].applied;
      sum.force += applied.value.force;
      sum.moment += applied.value.moment;
    }
  }

  // Norms of (3.5) and (3.6); those of the weight are in gamma.
  void load(std::size_t i) {
    const LinkNorms& link = links[i];
    const double gamma = counted(motions[i].gamma), U = gradient(motions[i]);
    const double mass = counted(link.mass), first = counted(link.first);
    const double second = counted(link.second);
    wrenches[i] = {counted(mass * gamma + first * U + link.applied.force),  // (3.5), + |f*|
                   counted(first * gamma + second * U + link.applied.moment)};
  }

  // Norms of (3.7) and (3.8).
  void addToParent(std::size_t k) {
    const JointNorms& joint = joints[k];
    const WrenchMagnitude& wrench = wrenches[k + 1];
    WrenchMagnitude& parent = wrenches[joint.parent_link];
    parent.force += wrench.force;
    parent.moment += wrench.moment + counted(joint.distance + slides[k]) * wrench.force;  // (3.8)
    if (joint.coordinate < 0) return;
    efforts[joint.coordinate] += joint.multiplier * (joint.slides ? wrench.force : wrench.moment);
  }

  void addTerms(const ResolvedJointTerms& term, const Motion& motion) {
    const JointNorms& joint = joints[term.joint];
    const double friction = rests ? 0 : term.coulomb;
    efforts[joint.coordinate] +=
        joint.multiplier *
        (term.stiffness * (position(joint, motion) + std::abs(term.rest)) +
         term.damping * rate(joint, motion) + friction +
         term.rotor_inertia * acceleration(joint, motion) + std::abs(term.offset));
  }

  bool rests;
  bool root_moves;
  double gravity;  // its norm, m/s^2
  double least = 0;
  Load own_load;  // the values in the scene
  std::vector<JointNorms> joints;
  std::vector<LinkNorms> links;
  std::vector<AppliedNorms> applied_wrenches;
  std::vector<ResolvedJointTerms> terms;
  std::vector<MotionSums> motions;  // by link
  std::vector<double> slides;       // by joint: norms of their displacements
  std::vector<WrenchMagnitude> wrenches;
  std::vector<int> depths;
  std::vector<double> efforts;
  std::vector<int> effort_depths;
};

ErrorBound::ErrorBound(const Mechanism& mechanism, const Scene& scene)
    : impl_(new Impl(LoadedMechanism(mechanism, scene).get(), openChain(scene))) {}

ErrorBound::~ErrorBound() = default;
ErrorBound::ErrorBound(ErrorBound&&) noexcept = default;
ErrorBound& ErrorBound::operator=(ErrorBound&&) noexcept = default;

void ErrorBound::compute(const Motion& motion, double least) {
  compute(motion, impl_->own_load, least);
}

void ErrorBound::compute(const Motion& motion, const Load& load, double least) {
  Impl& impl = *impl_;
  impl.least = least;
  requireLoad(load, impl.applied_wrenches.size());
  for (std::size_t i = 0; i < load.wrenches.size(); ++i) {
    impl.applied_wrenches[i].set(load.wrenches[i].force, load.wrenches[i].torque);
  }
  requireLengths(motion, static_cast<Eigen::Index>(impl.efforts.size()));
  std::fill(impl.efforts.begin(), impl.efforts.end(), 0.0);
  if (impl.root_moves && !impl.rests) impl.takeRoot(motion.root);
  for (std::size_t k = 0; k < impl.joints.size(); ++k) impl.move(k, motion);
  impl.addApplied();
  for (std::size_t i = 0; i < impl.links.size(); ++i) impl.load(i);
  for (std::size_t k = impl.joints.size(); k-- > 0;) impl.addToParent(k);
  for (const ResolvedJointTerms& term : impl.terms) impl.addTerms(term, motion);
}

const std::vector<WrenchMagnitude>& ErrorBound::wrenches() const {
  return impl_->wrenches;
}

const std::vector<double>& ErrorBound::efforts() const {
  return impl_->efforts;
}

const std::vector<int>& ErrorBound::depths() const {
  return impl_->depths;
}

const std::vector<int>& ErrorBound::effortDepths() const {
  return impl_->effort_depths;
}

}  // namespace virtual_work_dynamics
