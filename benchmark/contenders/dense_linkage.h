#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/QR>
#include <vector>

#include "contenders/robots.h"

namespace virtual_work_dynamics {

/// Closed loops as users compute them who have a library of trees: the recursion of Newton and
/// Euler in root axes, Jacobians of the points where loops are closed, and Eigen's dense
/// factorizations. It knows pins, balls and springs between points, takes every closure's
/// conditions as they are, and tells nothing of what is determined.
class DenseLinkage {
 public:
  /// Whether a scene has nothing else.
  static bool canCompute(const BenchmarkScene& scene);
  explicit DenseLinkage(const BenchmarkScene& scene);

  /// Positions, velocities and accelerations of the passive coordinates, from those of the others
  /// and a start. @returns whether the loops close.
  bool complete(Motion& motion);
  /// Efforts of all coordinates; those of the passive ones are zero.
  void computeEfforts(const Motion& motion, Eigen::VectorXd& efforts);

 private:
  struct Body {
    int parent;  // index into bodies_
    bool slides;
    Eigen::Matrix3d R_PK, inertia_Cm_K;
    Eigen::Vector3d p_PoKo_P, axis_K, p_KoCm_K;
    double mass;
    // All in root axes.
    Eigen::Matrix3d R;
    Eigen::Vector3d o, axis, w, v, alpha, a, force, moment;  // v, a, moment: of and about o
  };
  struct Point {
    int body;
    Eigen::Vector3d p_KoPo_K;
    Eigen::Matrix3d R_KF;
  };
  struct Loop {
    Point parent, child;
    bool is_pin;  // z of both frames in one line
    int first_row;
  };
  struct Spring {
    Point a, b;
    double stiffness, rest_length;
  };

  static Point pointOn(const Mechanism& mechanism, const std::string& link,
                       const Eigen::Vector3d& at, const Eigen::Vector3d& rpy);
  Eigen::Vector3d placeOf(const Point& point) const;
  Eigen::Vector3d velocityOf(const Point& point) const;
  Eigen::Vector3d accelerationOf(const Point& point) const;
  void setPosition(const Eigen::VectorXd& q);
  void setVelocity(const Eigen::VectorXd& qd);
  void setAcceleration(const Eigen::VectorXd& qdd, const Eigen::Vector3d& of_root);
  void addColumns(const Point& point, double sign, int first_row, const Eigen::Vector3d* turns);
  void setJacobian();
  void factorize();
  void solve();  // right_ becomes what is found
  void setMisfit();
  void setVelocityMisfit();
  void setAccelerationMisfit();
  void addForce(const Point& point, const Eigen::Vector3d& force);

  std::vector<Body> bodies_;  // the root first
  std::vector<Loop> loops_;
  std::vector<Spring> springs_;
  std::vector<int> passive_;
  Eigen::Vector3d gravity_;
  Eigen::MatrixXd jacobian_, of_passive_;  // rows by condition
  Eigen::VectorXd misfit_, found_, multipliers_, passive_efforts_;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;  // where of_passive_ is square
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr_;
  bool square_ = false;
};

}  // namespace virtual_work_dynamics
