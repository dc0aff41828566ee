#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "loop_geometry.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"

namespace virtual_work_dynamics {

/// The paper's other route through loops: Lagrange's equations with multipliers (3.1). The loops
/// are cut. LagrangeDynamics gives tau_tree and the columns of A^T, which are the generalized
/// forces of the constraint wrenches. Every reaction follows by (4.2) with the wrenches of the
/// closures applied. Where many solutions exist, the solution is one of least norm.
class LagrangeMultipliersOracle {
 public:
  using VectorXl = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
  using MatrixXl = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

  LagrangeMultipliersOracle(const Mechanism& mechanism, const Scene& scene, const Motion& motion);

  /// The effort of a generalized coordinate; zero for passive ones.
  double effort(Eigen::Index coordinate) const;

  /// The reaction of a joint, a closure or "ground" in root axes.
  Wrench rootAxes(const std::string& name) const;

 private:
  // A force, and a moment about the origin of the closure's child frame, in root axes.
  struct Direction {
    Vector3l force = Vector3l::Zero(), moment = Vector3l::Zero();
  };
  struct Multiplier {
    std::size_t closure;
    Direction wrench;
  };

  Scene treeScene() const;

  void addSprings();

  void apply(Scene& scene, const std::string& name, const Vector3l& point, const Vector3l& force,
             const Vector3l& moment) const;

  void applyPair(Scene& scene, std::size_t c, const Direction& wrench) const;

  bool actuated(const std::string& name) const;

  Eigen::VectorXd efforts(const Scene& scene) const;

  // The generalized force of a wrench: minus the efforts that hold it when nothing else acts.
  Eigen::VectorXd generalizedForce(std::size_t closure, const Direction& wrench) const;

  // The wrenches that a closure can exert.
  std::vector<Direction> directions(const Closure& closure) const;

  bool actuatedClosure(const Closure& closure) const;

  void solveReactions();

  const Mechanism& mechanism_;
  const Scene& scene_;
  const Motion& motion_;
  NewtonEulerOracle bodies_;
  Scene tree_;
  std::vector<Eigen::Index> actuated_;
  std::vector<Multiplier> multipliers_;
  VectorXl x_;
  std::vector<std::string> names_;
  std::vector<Wrench> reactions_;
};

}  // namespace virtual_work_dynamics
