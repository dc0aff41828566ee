#include "virtual_work_dynamics/momentum_observer.h"

#include <cmath>
#include <limits>
#include <utility>

#include "base/number_text.h"
#include "base/printable.h"
#include "dynamics/momentum_terms.h"
#include "scene/payloads.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

Request effortsOnly() {
  return Request();
}

// Refuses what p' = tau + beta does not hold for in these coordinates.
const Scene& checked(const Mechanism& mechanism, const Scene& scene, double gain) {
  if (!(gain > 0) || !std::isfinite(gain)) {
    throw SceneError("momentum observer: the gain " + numberText(gain) +
                     " 1/s is not a positive number");
  }
  if (needsClosedLoops(scene)) {
    throw SceneError("momentum observer: closed loops and passive joints are not observed");
  }
  if (scene.static_motion) {
    throw SceneError("momentum observer: a static scene has no momentum");
  }
  if (mechanism.orientations() > 0) {
    throw SceneError("momentum observer: joint " + inQuotes(mechanism.freeJoint(0).name) +
                     " turns freely, which is not observed");
  }
  return scene;
}

// The mechanism without masses, so that only what acts at the joints is left of its efforts.
Mechanism withoutMasses(const Mechanism& mechanism) {
  std::vector<Link> links = mechanism.links();
  for (Link& link : links) {
    link.mass = 0;
    link.inertia_Cm_K.setZero();
  }
  return Mechanism(mechanism.name(), std::move(links), mechanism.joints(), {},
                   mechanism.compounds());
}

Scene ofJointsOnly(const Scene& scene) {
  Scene joints;
  joints.gravity.setZero();
  joints.joints = scene.joints;
  joints.use_urdf_dynamics = scene.use_urdf_dynamics;
  joints.joint_types = scene.joint_types;
  return joints;
}

// Efforts of a plan without what the motion does not ask for.
class Efforts {
 public:
  Efforts(const Mechanism& mechanism, const Scene& scene)
      : dynamics_(mechanism, scene, effortsOnly()), workspace_(dynamics_.makeWorkspace()) {}

  const Eigen::VectorXd& at(const Motion& motion, const Load& load) {
    dynamics_.compute(motion, load, workspace_);
    return workspace_.results().effort;
  }

 private:
  Dynamics dynamics_;
  Dynamics::Workspace workspace_;
};

}  // namespace

struct MomentumObserver::Impl {
  Impl(const Mechanism& mechanism, const Scene& scene, double gain)
      : gain_(gain),
        root_moves_(checked(mechanism, scene, gain).root_moves),
        at_rest_(mechanism, scene),
        joints_(withoutMasses(mechanism), ofJointsOnly(scene)),
        bodies_(LoadedMechanism(mechanism, scene).get()),
        still_(static_cast<Eigen::Index>(mechanism.coordinates().size())),
        moving_(still_),
        momentum_(still_.q),
        beta_(still_.q),
        force_(still_.q),
        force_before_(still_.q),
        momentum_before_(still_.q),
        external_(Eigen::VectorXd::Constant(still_.q.size(), kNotKnown)) {}

  // Everything of the sample's own: momentum_ and beta_.
  void evaluate(const Motion& motion, const Load& load) {
    const Eigen::Vector3d root_rate =
        root_moves_
            ? Eigen::Vector3d(motion.root.orientation.conjugate() * motion.root.angular_velocity)
            : Eigen::Vector3d::Zero();
    bodies_.compute(motion, root_rate);
    still_.q = moving_.q = motion.q;
    if (root_moves_) {
      still_.root.orientation = motion.root.orientation;
      still_.root.acceleration = motion.root.acceleration;
    }
    beta_ = bodies_.gradient() - at_rest_.at(still_, load);
    const Load none;
    const Eigen::VectorXd& resting = joints_.at(still_, none);
    beta_ += resting;
    momentum_ = bodies_.momentum() - resting;
    moving_.qd = motion.qd;
    moving_.qdd.setZero();
    beta_ -= joints_.at(moving_, none);  // friction
    moving_.qd.setZero();
    moving_.qdd = motion.qd;
    momentum_ += joints_.at(moving_, none);  // rotors
  }

  void step(double time, const Eigen::VectorXd& measured) {
    force_ = measured + beta_;
    const double length = time - time_before_;
    const double stays = started_ ? std::exp(-gain_ * length) : 0;
    for (Eigen::Index i = 0; i < force_.size(); ++i) {
      if (!std::isfinite(force_[i])) {
        external_[i] = kNotKnown;
      } else if (!started_ || !std::isfinite(force_before_[i])) {
        external_[i] = 0;
      } else {
        const double mean =
            (momentum_[i] - momentum_before_[i]) / length - 0.5 * (force_before_[i] + force_[i]);
        external_[i] = stays * external_[i] + (1 - stays) * mean;
      }
    }
    momentum_before_ = momentum_;
    force_before_ = force_;
    time_before_ = time;
    started_ = true;
  }

  const double gain_;
  const bool root_moves_;
  Efforts at_rest_, joints_;
  MomentumTerms bodies_;
  Motion still_, moving_;
  Eigen::VectorXd momentum_, beta_;
  Eigen::VectorXd force_, force_before_, momentum_before_, external_;
  double time_before_ = 0;
  bool started_ = false;
};

MomentumObserver::MomentumObserver(const Mechanism& mechanism, const Scene& scene, double gain)
    : impl_(std::make_unique<Impl>(mechanism, scene, gain)) {}
MomentumObserver::~MomentumObserver() = default;
MomentumObserver::MomentumObserver(MomentumObserver&&) noexcept = default;
MomentumObserver& MomentumObserver::operator=(MomentumObserver&&) noexcept = default;

void MomentumObserver::step(double time, const Motion& motion, const Load& load,
                            const Eigen::VectorXd& measured) {
  if (measured.size() != impl_->beta_.size()) {
    throw MotionError("momentum observer: " + std::to_string(measured.size()) +
                      " measured efforts, expected " + std::to_string(impl_->beta_.size()));
  }
  if (impl_->started_ && !(time > impl_->time_before_)) {
    throw MotionError("momentum observer: time " + numberText(time) +
                      " s is not later than the one before");
  }
  impl_->evaluate(motion, load);
  impl_->step(time, measured);
}

void MomentumObserver::restart() {
  impl_->started_ = false;
  impl_->external_.setConstant(kNotKnown);
}

const Eigen::VectorXd& MomentumObserver::external() const {
  return impl_->external_;
}
const Eigen::VectorXd& MomentumObserver::momentum() const {
  return impl_->momentum_;
}
const Eigen::VectorXd& MomentumObserver::momentumRate() const {
  return impl_->beta_;
}

}  // namespace virtual_work_dynamics
