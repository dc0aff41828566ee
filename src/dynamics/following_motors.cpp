#include "dynamics/following_motors.h"

#include <algorithm>
#include <cstddef>
#include <set>

namespace virtual_work_dynamics {

// withTransmissions() has added the couplings that tie actuators after those of the scene, each
// with its actuator first.
FollowingMotors::FollowingMotors(const Mechanism& mechanism, const Scene& scene,
                                 const std::vector<bool>& given)
    : coordinates_(given.size(), false) {
  std::set<std::string> lacking;
  for (const auto& [joint, actuators] : scene.actuators_of) {
    for (const std::string& actuator : actuators) {
      const auto place = static_cast<std::size_t>(mechanism.coordinateIndex(actuator));
      if (!given[place]) lacking.insert(actuator);
    }
  }
  for (auto coupling = scene.couplings.rbegin(); coupling != scene.couplings.rend(); ++coupling) {
    const std::string& name = coupling->terms.front().name;
    if (lacking.erase(name) == 0) continue;
    Motor motor{name, mechanism.coordinateIndex(name), *coupling->offset, {}};
    for (auto term = coupling->terms.begin() + 1; term != coupling->terms.end(); ++term) {
      motor.terms.push_back({mechanism.coordinateIndex(term->name), -term->value});
    }
    const bool follows = std::all_of(motor.terms.begin(), motor.terms.end(), [&](const Term& term) {
      return given[static_cast<std::size_t>(term.joint)];
    });
    if (!follows) continue;
    coordinates_[static_cast<std::size_t>(motor.coordinate)] = true;
    motors_.push_back(motor);
  }
}

std::vector<std::string> FollowingMotors::names() const {
  std::vector<std::string> names;
  for (const Motor& motor : motors_) names.push_back(motor.name);
  std::reverse(names.begin(), names.end());
  return names;
}

void FollowingMotors::placeIn(Eigen::VectorXd& q) const {
  for (const Motor& motor : motors_) {
    double position = motor.offset;
    for (const Term& term : motor.terms) position += term.ratio * q[term.joint];
    q[motor.coordinate] = position;
  }
}

void FollowingMotors::set(Motion& motion) const {
  placeIn(motion.q);
  for (Eigen::VectorXd* rates : {&motion.qd, &motion.qdd}) {
    for (const Motor& motor : motors_) {
      double rate = 0;
      for (const Term& term : motor.terms) rate += term.ratio * (*rates)[term.joint];
      (*rates)[motor.coordinate] = rate;
    }
  }
}

void FollowingMotors::set(MotionTable& table) const {
  const auto all = coordinates_.size();
  for (const Motor& motor : motors_) {
    const Eigen::Index to = motor.coordinate;
    table.positions.col(to).setConstant(motor.offset);
    table.velocities.col(to).setZero();
    table.accelerations.col(to).setZero();
    for (const Term& term : motor.terms) {
      for (Eigen::MatrixXd* level : {&table.positions, &table.velocities, &table.accelerations}) {
        level->col(to) += term.ratio * level->col(term.joint);
      }
    }
    for (std::size_t first = 0; first < table.covariances.size(); first += all) {
      Eigen::Matrix3d& sum = table.covariances[first + static_cast<std::size_t>(to)];
      sum.setZero();
      for (const Term& term : motor.terms) {
        sum += term.ratio * term.ratio *
               table.covariances[first + static_cast<std::size_t>(term.joint)];
      }
    }
  }
}

void FollowingMotors::set(MotionCovariance& covariance) const {
  for (const Motor& motor : motors_) {
    Eigen::Matrix3d& sum = covariance.coordinates[static_cast<std::size_t>(motor.coordinate)];
    sum.setZero();
    for (const Term& term : motor.terms) {
      sum += term.ratio * term.ratio * covariance.coordinates[static_cast<std::size_t>(term.joint)];
    }
  }
}

void FollowingMotors::loosen(MotionCovariance& covariance) const {
  constexpr double kLoose = 1e12;  // against variances of what is measured
  for (const Motor& motor : motors_) {
    covariance.coordinates[static_cast<std::size_t>(motor.coordinate)] =
        kLoose * Eigen::Matrix3d::Identity();
  }
}

}  // namespace virtual_work_dynamics
