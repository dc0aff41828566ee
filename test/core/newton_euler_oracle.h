#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// Inverse dynamics by Newton's and Euler's equations about every link's centre of mass, in
/// inertial axes and long double, link by link without lumping; the wrench at a joint is a plain
/// sum over the links that it carries. Inertial axes are those of a root that rests. Shares only
/// the Mechanism with the recursion under test.
class NewtonEulerOracle {
 public:
  NewtonEulerOracle(const Mechanism& mechanism, const Scene& scene, const Motion& motion);

  struct RootWrench {
    Vector3l force, torque;
  };

  /// Wrench of the parent on the child about the joint origin, root axes; joint -1: ground.
  RootWrench reaction(int joint) const;

  /// Wrench of the parent on the child about the joint origin, in axes of the child link.
  RootWrench childReaction(int joint) const;

  /// Effort of every generalized coordinate, mimic joints included.
  std::vector<long double> efforts() const;

  const Matrix3l& orientation(int link) const { return links_[link].R; }
  const Vector3l& origin(int link) const { return links_[link].o; }
  const Vector3l& originVelocity(int link) const { return links_[link].v; }
  const Vector3l& angularVelocity(int link) const { return links_[link].w; }
  const Vector3l& centreOfMass(int link) const { return links_[link].c; }

  /// The wrench that all joints of a link together exert on it, about its centre of mass, in root
  /// axes.
  RootWrench demand(int link) const { return {links_[link].force, links_[link].moment_c}; }

 private:
  struct State {
    Matrix3l R = Matrix3l::Identity();  // link -> inertial axes
    Vector3l o = Vector3l::Zero(), v = Vector3l::Zero(), a = Vector3l::Zero();
    Vector3l w = Vector3l::Zero(), alpha = Vector3l::Zero();
    Vector3l c, force, moment_c;  // centre of mass; wrench of all joints on the link, about it
  };
  void moveRoot(const Scene& scene, const RootMotion& motion);
  void moveLink(std::size_t k, const Scene& scene, const Motion& motion);
  void forceOnLink(std::size_t i, const Scene& scene);
  bool carries(int joint, int link) const;

  const Mechanism& mechanism_;
  std::vector<State> links_;
};

}  // namespace virtual_work_dynamics
