#pragma once

#include <Eigen/Core>
#include <array>

#include "virtual_work_dynamics/free_turn.h"
#include "virtual_work_dynamics/motion_covariance.h"
#include "virtual_work_dynamics/noise_settings.h"
#include "virtual_work_dynamics/root_motion.h"

namespace virtual_work_dynamics {

/// The motion of a root link as seven coordinates, its position and a quaternion (x, y, z, w), with
/// their first and second derivatives in the columns: m and 1, per s, per s^2. As functions of time
/// they are smooth at every attitude, while three angles or a rotation vector are not. A quaternion
/// and its opposite are one attitude.
///
/// Where a component of a quaternion is 1 or -1, an error of the attitude does not show in it, and
/// its noise is not that of other attitudes. So that this is not so where robots rest, the
/// quaternion is that of the root's axes with their names exchanged in a cycle: R_I0 (1 + i + j +
/// k) / 2.
using RootCoordinates = Eigen::Matrix<double, 7, 3>;

/// q' = w q / 2, q'' = (w' q + w q') / 2, with the product of quaternions and the angular velocity
/// w in inertial axes. Does not allocate.
RootCoordinates coordinatesOf(const RootMotion& motion);

/// The motion that coordinates mean whose quaternion, as estimated or interpolated, is not quite of
/// unit length: that of q / |q|, w = 2 vec(q' q*) / |q|^2. The quaternion must not be zero. Does
/// not allocate.
RootMotion rootMotionOf(const RootCoordinates& coordinates);

/// Covariances of each of the RootCoordinates and its derivatives, estimated one by one.
using RootCoordinateCovariances = std::array<Eigen::Matrix3d, RootCoordinates::RowsAtCompileTime>;

/// The covariance of rootMotionOf() coordinates that were estimated one by one. Errors of attitudes
/// are taken to be alike about all axes: in the four numbers of a quaternion they are then spread
/// evenly over the three directions that turn it, so that the sum of four covariances tells them,
/// and no attitude is special. Does not allocate.
RootCovariance rootCovarianceOf(const RootMotion& motion, const RootCoordinateCovariances& each);

/// The covariance of how a body turns, of which `motion` says orientation, angular velocity and
/// acceleration: the turn about its own axes, the others in inertial axes.
TurnCovariance turnCovarianceOf(const RootMotion& motion, const RootCoordinateCovariances& each);

/// What the streams of a quaternion's four numbers say of the turn: noises in rad and rad/s about
/// each axis, as turnCovarianceOf() has them.
StreamQuality turnQuality(const std::array<StreamQuality, 4>& quaternion);

/// Of a turn whose angular velocity and acceleration are in the axes of the body, what
/// turnCovarianceOf() says of them in axes of the parent.
TurnCovariance inBodyAxes(const FreeTurn& turn, const TurnCovariance& covariance);

/// Makes the quaternion, with its derivatives, that of the two opposite ones which is the closer to
/// that of `before`.
void chooseSign(const RootCoordinates& before, RootCoordinates& coordinates);

}  // namespace virtual_work_dynamics
