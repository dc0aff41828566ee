#include "virtual_work_dynamics/certificates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "base/aligned_memory.h"
#include "scene/input_checks.h"
#include "scene/joint_terms.h"
#include "scene/payloads.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/instruction_set.h"
#include "witness/geared_angle.h"
#include "witness/momentum/welded_bodies.h"

namespace virtual_work_dynamics {

namespace {

// Magnitudes below this have lost digits to underflow: differences count as parts of it. It also
// turns 0/0 into 0.
constexpr double kLeastScale =
    std::numeric_limits<double>::min() / std::numeric_limits<double>::epsilon();

// A scale that overflowed says nothing about what is within it.
double usable(double scale) {
  if (!(scale <= std::numeric_limits<double>::max())) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return std::max(scale, kLeastScale);
}

double relative(double difference, double scale) {
  return std::abs(difference) / usable(scale);
}

double relative(const Eigen::Vector3d& found, const double* expected, double scale) {
  const double unit = 1 / usable(scale);  // before squares are taken, which may overflow
  const double x = unit * (found.x() - expected[0]), y = unit * (found.y() - expected[1]),
               z = unit * (found.z() - expected[2]);
  return std::sqrt(x * x + y * y + z * z);
}

Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d A;
  A << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return A;
}

// How a joint follows its generalized coordinate.
struct Drive {
  int coordinate = -1;
  bool slides = false;
  bool geared = false;
  double multiplier = 1;
  double offset = 0;

  explicit Drive(const Joint& joint)
      : coordinate(joint.coordinate),
        slides(joint.type == JointType::kPrismatic),
        geared(joint.multiplier != 1 || joint.offset != 0),
        multiplier(joint.multiplier),
        offset(joint.offset) {}
};

// Cosine and sine of a joint's angle.
void cosineAndSine(const Drive& drive, double q, double& cosine, double& sine) {
  if (drive.geared) {
    gearedCosineAndSine(drive.multiplier, q, drive.offset, cosine, sine);
  } else {
    cosine = std::cos(q);
    sine = std::sin(q);
  }
}

// Sets to = from Rz, matrices by columns.
void turn(const double* from, double cosine, double sine, double* to) {
  for (int i = 0; i < 3; ++i) {
    to[i] = cosine * from[i] + sine * from[i + 3];
    to[i + 3] = cosine * from[i + 3] - sine * from[i];
  }
}

const Momentum& chosenMomentum() {
  const bool avx2 = chosenInstructionSet() != InstructionSet::kBaseline && avx2Momentum();
  return avx2 ? *avx2Momentum() : *baselineMomentum();
}

}  // namespace

double Certificates::largest() const {
  double largest = power;
  for (const double value : {ground_force, ground_moment}) {
    if (!(value <= largest)) largest = std::isnan(largest) ? largest : value;
  }
  return largest;
}

struct Certifier::Impl {
  Impl(const Mechanism& mechanism, const Scene& scene)
      : rests(scene.static_motion),
        root_moves(scene.root_moves),
        gravity(scene.gravity),
        coordinates(static_cast<Eigen::Index>(mechanism.coordinates().size())),
        terms(resolveJointTerms(mechanism, scene)),
        welded(mechanism),
        joints(welded.bodies.size()),
        momentum(chosenMomentum()),
        memory(momentum.state_size * welded.bodies.size()),
        own_load(scene) {
    for (std::size_t b = 1; b < welded.bodies.size(); ++b) {
      drives.emplace_back(mechanism.joints()[welded.joints[b]]);
      const double* const R_PZ = welded.bodies[b].R_PZ;
      std::copy(R_PZ, R_PZ + 9, joints[b].R_PZ);
    }
    for (const ResolvedJointTerms& term : terms) {
      term_drives.emplace_back(mechanism.joints()[term.joint]);
    }
    for (std::size_t i = 0; i < scene.applied_wrenches.size(); ++i) addWrench(mechanism, scene, i);
    inputs.bodies = welded.bodies.data();
    inputs.joints = joints.data();
    inputs.body_count = welded.bodies.size();
    inputs.wrenches = wrenches.data();
    inputs.wrench_count = wrenches.size();
    for (int i = 0; i < 3; ++i) inputs.gamma_root[i] = -scene.gravity[i];
    inputs.gamma_norm = static_cast<double>(scene.gravity.cast<long double>().norm());
  }

  void addWrench(const Mechanism& mechanism, const Scene& scene, std::size_t index) {
    const AppliedWrench& applied = scene.applied_wrenches[index];
    const LinkPlace& place = welded.places[linkOf(mechanism, scene, index)];
    MomentumWrench wrench;
    wrench.body = place.body;
    wrench.in_root_axes = applied.axes == Axes::kRoot;
    const Vector3l at = applied.at.cast<long double>();
    const Vector3l p_ZoA_Z = place.p_ZoLo_Z + place.R_ZL * at;
    for (int i = 0; i < 3; ++i) wrench.p_ZoA_Z[i] = static_cast<double>(p_ZoA_Z[i]);
    wrenches.push_back(wrench);
    wrench_axes.push_back(place.R_ZL);
    wrench_arms.push_back(static_cast<double>(place.distance + at.norm()));
  }

  void setWrench(std::size_t index, const Eigen::Vector3d& force, const Eigen::Vector3d& torque) {
    MomentumWrench& wrench = wrenches[index];
    const Matrix3l R = wrench.in_root_axes ? Matrix3l(Matrix3l::Identity()) : wrench_axes[index];
    const Vector3l f = R * force.cast<long double>(), t = R * torque.cast<long double>();
    for (int i = 0; i < 3; ++i) {
      wrench.force[i] = static_cast<double>(f[i]);
      wrench.torque[i] = static_cast<double>(t[i]);
    }
    wrench.force_norm = static_cast<double>(f.norm());
    wrench.moment_norm = static_cast<double>(t.norm() + wrench_arms[index] * f.norm());
  }

  // D = w~ R and E = (w~ w~ + alpha~) R of the root, where R is the unit matrix.
  void takeRoot(const RootMotion& motion) {
    const RootState state(motion, gravity, rests);
    const Eigen::Matrix3d D = crossMatrix(state.angular_velocity);
    const Eigen::Matrix3d E = crossMatrix(state.angular_acceleration) + D * D;
    std::copy_n(D.data(), 9, inputs.root_D);
    std::copy_n(E.data(), 9, inputs.root_E);
    std::copy_n(state.acceleration.data(), 3, inputs.gamma_root);
    inputs.w_norm = state.angular_velocity.norm();
    inputs.alpha_norm = state.angular_acceleration.norm();
    inputs.gamma_norm = gravity.norm() + (rests ? 0 : motion.acceleration.norm());
    root_rate = state.angular_velocity;
  }

  void takeMotion(const Motion& motion) {
    if (root_moves) takeRoot(motion.root);
    for (const WeldedBodies::Oriented& turned : welded.oriented) {
      const Eigen::Matrix3d R = motion.orientations.empty()
                                    ? Eigen::Matrix3d(Eigen::Matrix3d::Identity())
                                    : motion.orientations[turned.orientation].toRotationMatrix();
      const Eigen::Matrix3d R_PZ = turned.before * R * turned.after;
      std::copy_n(R_PZ.data(), 9, welded.bodies[turned.body].R_PZ);
      std::copy_n(R_PZ.data(), 9, joints[turned.body].R_PZ);  // turn() leaves its axis as it is
    }
    for (std::size_t i = 0; i < drives.size(); ++i) {
      const Drive& drive = drives[i];
      MomentumJoint& joint = joints[i + 1];
      const double q = motion.q[drive.coordinate];
      if (drive.slides) {
        joint.slide = drive.multiplier * q + drive.offset;
        joint.slide_norm = std::abs(drive.multiplier * q) + std::abs(drive.offset);
      } else {
        double cosine, sine;
        cosineAndSine(drive, q, cosine, sine);
        turn(welded.bodies[i + 1].R_PZ, cosine, sine, joint.R_PZ);
      }
      if (rests) continue;
      joint.rate = drive.multiplier * motion.qd[drive.coordinate];
      joint.acceleration = drive.multiplier * motion.qdd[drive.coordinate];
    }
  }

  // Adds the power of joint terms, W, and of the magnitudes of their terms.
  void addTerms(const Motion& motion, double& power, double& scale) const {
    for (std::size_t i = 0; i < terms.size(); ++i) {
      const ResolvedJointTerms& term = terms[i];
      const Drive& drive = term_drives[i];
      const double turned = drive.multiplier * motion.q[drive.coordinate];
      const double rate = drive.multiplier * motion.qd[drive.coordinate];
      const double acceleration = drive.multiplier * motion.qdd[drive.coordinate];
      const double s = std::max(-1.0, std::min(1.0, rate / term.coulomb_velocity));
      const double friction = s * (3 - s * s) / 2;
      power += rate * (term.stiffness * (turned + drive.offset - term.rest) + term.damping * rate +
                       term.coulomb * friction + term.rotor_inertia * acceleration + term.offset);
      scale += std::abs(rate) *
               (term.stiffness * (std::abs(turned) + std::abs(drive.offset) + std::abs(term.rest)) +
                term.damping * std::abs(rate) + term.coulomb +
                term.rotor_inertia * std::abs(acceleration) + std::abs(term.offset));
    }
  }

  // Power of the efforts, W. Efforts at rest have none, unless they are not numbers.
  double powerOf(const Eigen::VectorXd& effort, const Motion& motion) const {
    double power = 0;
    for (Eigen::Index i = 0; i < coordinates; ++i) power += effort[i] * (rests ? 0 : motion.qd[i]);
    return power;
  }

  bool rests;
  bool root_moves;
  Eigen::Vector3d gravity;
  Eigen::Vector3d root_rate = Eigen::Vector3d::Zero();  // root axes, rad/s
  Eigen::Index coordinates;
  std::vector<ResolvedJointTerms> terms;
  std::vector<Drive> term_drives;
  WeldedBodies welded;
  std::vector<Drive> drives;  // of all bodies except the root
  std::vector<MomentumJoint> joints;
  std::vector<MomentumWrench> wrenches;
  std::vector<Matrix3l> wrench_axes;  // R_ZL
  std::vector<double> wrench_arms;    // from the body's origin, by norms
  const Momentum& momentum;
  AlignedMemory memory;
  MomentumInputs inputs;
  Load own_load;  // the values in the scene
};

Certifier::Certifier(const Mechanism& mechanism, const Scene& scene)
    : impl_(new Impl(LoadedMechanism(mechanism, scene).get(), openChain(scene))) {}

Certifier::~Certifier() = default;
Certifier::Certifier(Certifier&&) noexcept = default;
Certifier& Certifier::operator=(Certifier&&) noexcept = default;

Request Certifier::extended(Request request) {
  request.efforts = true;
  auto& names = request.child_axes;
  if (std::find(names.begin(), names.end(), kGround) == names.end()) names.emplace_back(kGround);
  return request;
}

std::size_t Certifier::groundIndex(const Request& extended) {
  const auto& names = extended.child_axes;
  const auto found = std::find(names.begin(), names.end(), kGround);
  if (found == names.end()) {
    throw SceneError("certificates: the reaction of ground is not requested in child axes");
  }
  return static_cast<std::size_t>(found - names.begin());
}

Certificates Certifier::check(const Motion& motion, const Eigen::VectorXd& effort,
                              const Wrench& ground) {
  return check(motion, impl_->own_load, effort, ground);
}

Certificates Certifier::check(const Motion& motion, const Load& load, const Eigen::VectorXd& effort,
                              const Wrench& ground) {
  Impl& impl = *impl_;
  requireLengths(motion, impl.coordinates);
  requireOrientations(motion, impl.welded.oriented.size());
  requireLoad(load, impl.wrenches.size());
  if (effort.size() != impl.coordinates) {
    throw MotionError("certificates: effort has " + std::to_string(effort.size()) +
                      " entries, the mechanism has " + std::to_string(impl.coordinates) +
                      " coordinates");
  }
  for (std::size_t i = 0; i < load.wrenches.size(); ++i) {
    impl.setWrench(i, load.wrenches[i].force, load.wrenches[i].torque);
  }
  impl.takeMotion(motion);
  MomentumSums sums;
  impl.momentum.sum(impl.inputs, impl.memory.get(), sums);
  if (!impl.rests) impl.addTerms(motion, sums.power, sums.power_scale);
  // Ground's force has no power, as the root's origin has no velocity in the frame of the sums.
  const double power = impl.powerOf(effort, motion) + ground.torque.dot(impl.root_rate);
  return {relative(power - sums.power, sums.power_scale),
          relative(ground.force, sums.force, sums.force_scale),
          relative(ground.torque, sums.moment, sums.moment_scale)};
}

}  // namespace virtual_work_dynamics
