#include "lagrange_multipliers_oracle.h"

#include <Eigen/Dense>
#include <algorithm>

#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/lagrange_dynamics.h"

namespace virtual_work_dynamics {

LagrangeMultipliersOracle::LagrangeMultipliersOracle(const Mechanism& mechanism, const Scene& scene,
                                                     const Motion& motion)
    : mechanism_(mechanism),
      scene_(scene),
      motion_(motion),
      bodies_(mechanism, treeScene(), motion),
      tree_(treeScene()) {
  addSprings();
  const Eigen::VectorXd tau_tree = efforts(tree_);
  const Eigen::Index n = tau_tree.size();
  MatrixXl G(n, 0);
  const auto append = [&](const Eigen::VectorXd& column) {
    G.conservativeResize(Eigen::NoChange, G.cols() + 1);
    G.rightCols<1>() = column.cast<long double>();
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    if (actuated(mechanism.coordinateNames()[static_cast<std::size_t>(i)])) {
      actuated_.push_back(i);
      append(Eigen::VectorXd::Unit(n, i));
    }
  }
  for (std::size_t c = 0; c < scene.closures.size(); ++c) {
    for (const auto& wrench : directions(scene.closures[c])) {
      multipliers_.push_back({c, wrench});
      append(generalizedForce(c, wrench));
    }
  }
  x_ = G.completeOrthogonalDecomposition().solve(tau_tree.cast<long double>());
  solveReactions();
}

double LagrangeMultipliersOracle::effort(Eigen::Index coordinate) const {
  for (std::size_t i = 0; i < actuated_.size(); ++i) {
    if (actuated_[i] == coordinate) return static_cast<double>(x_[static_cast<Eigen::Index>(i)]);
  }
  return 0;
}

Wrench LagrangeMultipliersOracle::rootAxes(const std::string& name) const {
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (names_[i] == name) return reactions_[i];
  }
  throw SceneError("no reaction of '" + name + "'");
}

Scene LagrangeMultipliersOracle::treeScene() const {
  Scene scene = scene_;
  scene.closures.clear();
  scene.springs.clear();
  scene.actuated.reset();
  scene.assembly.clear();
  scene.redundancy = {};
  return scene;
}

void LagrangeMultipliersOracle::addSprings() {
  for (const PointSpring& spring : scene_.springs) {
    const SpringForce pull(mechanism_, bodies_, spring);
    apply(tree_, spring.link_a, pull.a, pull.force_on_a, Vector3l::Zero());
    apply(tree_, spring.link_b, pull.b, -pull.force_on_a, Vector3l::Zero());
  }
}

void LagrangeMultipliersOracle::apply(Scene& scene, const std::string& name, const Vector3l& point,
                                      const Vector3l& force, const Vector3l& moment) const {
  const int link = mechanism_.linkIndex(name);
  AppliedWrench applied;
  applied.link = name;
  applied.at = (bodies_.orientation(link).transpose() * (point - bodies_.origin(link)))
                   .template cast<double>();
  applied.axes = Axes::kRoot;
  applied.force = force.cast<double>();
  applied.torque = moment.cast<double>();
  scene.applied_wrenches.push_back(applied);
}

void LagrangeMultipliersOracle::applyPair(Scene& scene, std::size_t c,
                                          const Direction& wrench) const {
  const Closure& closure = scene_.closures[c];
  const Vector3l point = PlacedFrame(mechanism_, bodies_, closure.child).o;
  apply(scene, closure.child.link, point, wrench.force, wrench.moment);
  apply(scene, closure.parent.link, point, -wrench.force, -wrench.moment);
}

bool LagrangeMultipliersOracle::actuated(const std::string& name) const {
  if (!scene_.actuated) return true;
  return std::count(scene_.actuated->begin(), scene_.actuated->end(), name) > 0;
}

Eigen::VectorXd LagrangeMultipliersOracle::efforts(const Scene& scene) const {
  LagrangeDynamics<long double> lagrange(mechanism_, scene, {});
  lagrange.compute(motion_);
  return lagrange.effort();
}

Eigen::VectorXd LagrangeMultipliersOracle::generalizedForce(std::size_t closure,
                                                            const Direction& wrench) const {
  Scene scene;
  scene.gravity.setZero();
  scene.static_motion = true;
  applyPair(scene, closure, wrench);
  return -efforts(scene);
}

std::vector<LagrangeMultipliersOracle::Direction> LagrangeMultipliersOracle::directions(
    const Closure& closure) const {
  using Type = ClosureType;
  const PlacedFrame parent(mechanism_, bodies_, closure.parent);
  const PlacedFrame child(mechanism_, bodies_, closure.child);
  const Matrix3l& R = parent.R;
  std::vector<Direction> all;
  const auto force = [&](const Vector3l& f) { all.push_back({f, Vector3l::Zero()}); };
  const auto moment = [&](const Vector3l& m) { all.push_back({Vector3l::Zero(), m}); };
  if (closure.type == Type::kDistance) {
    force((child.o - parent.o).normalized());
    return all;
  }
  const bool slides = closure.type == Type::kPrismatic || closure.type == Type::kCylindrical;
  const bool acts = actuatedClosure(closure);
  if (closure.type != Type::kPlanar) {
    force(R.col(0));
    force(R.col(1));
  }
  if (!slides || acts) force(R.col(2));
  if (closure.type == Type::kUniversal) moment(R.col(2).cross(child.R.col(0)));
  if (closure.type == Type::kUniversal || closure.type == Type::kSpherical) return all;
  moment(R.col(0));
  moment(R.col(1));
  if (closure.type == Type::kFixed || closure.type == Type::kPrismatic || acts) {
    moment(R.col(2));
  }
  return all;
}

bool LagrangeMultipliersOracle::actuatedClosure(const Closure& closure) const {
  return scene_.actuated && actuated(closure.name);
}

void LagrangeMultipliersOracle::solveReactions() {
  std::vector<Wrench> closures(scene_.closures.size());
  Scene loaded = tree_;
  for (std::size_t i = 0; i < multipliers_.size(); ++i) {
    const long double lambda = x_[static_cast<Eigen::Index>(actuated_.size() + i)];
    const auto& [closure, unit] = multipliers_[i];
    const Direction wrench{lambda * unit.force, lambda * unit.moment};
    closures[closure].force += wrench.force.cast<double>();
    closures[closure].torque += wrench.moment.cast<double>();
    applyPair(loaded, closure, wrench);
  }
  Request request;
  request.root_axes.emplace_back(kGround);
  for (const Joint& joint : mechanism_.joints()) request.root_axes.push_back(joint.name);
  LagrangeDynamics<long double> lagrange(mechanism_, loaded, request);
  lagrange.compute(motion_);
  names_ = request.root_axes;
  reactions_ = lagrange.rootAxes();
  for (std::size_t c = 0; c < closures.size(); ++c) {
    names_.push_back(scene_.closures[c].name);
    reactions_.push_back(closures[c]);
  }
}

}  // namespace virtual_work_dynamics
