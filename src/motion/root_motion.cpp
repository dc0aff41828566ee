#include "virtual_work_dynamics/root_motion.h"

namespace virtual_work_dynamics {

static_assert(sizeof(RootState) == RootState::kNumbers * sizeof(double), "nothing between vectors");

RootState::RootState(const RootMotion& motion, const Eigen::Vector3d& gravity, bool rests) {
  const Eigen::Matrix3d R_0I = motion.orientation.toRotationMatrix().transpose();
  if (rests) {
    angular_velocity.setZero();
    angular_acceleration.setZero();
    acceleration.noalias() = R_0I * -gravity;
    return;
  }
  angular_velocity.noalias() = R_0I * motion.angular_velocity;
  angular_acceleration.noalias() = R_0I * motion.angular_acceleration;
  acceleration.noalias() = R_0I * (motion.acceleration - gravity);
}

}  // namespace virtual_work_dynamics
