#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "closed_loop_results.h"
#include "newton_euler_oracle.h"
#include "random_cases.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

using VectorXl = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
using MatrixXl = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

// A change of a result, of a unit vector of changes, that is none.
constexpr long double kNoChange = 1e-9L;
// Some hundred roundings, amplified by the condition of the system.
constexpr double kPerCondition = 100 * 2.2e-16;

// Efforts and couplings' efforts by the equation they satisfy, S tau + C^T lambda = tau_tree,
// solved in long double from Newton's and Euler's equations of the tree; what is determined by the
// null space of [S C^T].
class CouplingsOracle {
 public:
  CouplingsOracle(const Mechanism& mechanism, const Scene& scene, const Motion& motion)
      : bodies_(mechanism, treeOf(scene), motion) {
    const auto n = static_cast<Eigen::Index>(mechanism.coordinates().size());
    const auto couplings = static_cast<Eigen::Index>(scene.couplings.size());
    for (Eigen::Index i = 0; i < n; ++i) {
      const std::string& name = mechanism.coordinateNames()[static_cast<std::size_t>(i)];
      const auto& all = *scene.actuated;
      if (std::find(all.begin(), all.end(), name) != all.end()) actuated_.push_back(i);
    }
    efforts_ = static_cast<Eigen::Index>(actuated_.size());
    B_.setZero(n, efforts_ + couplings);
    for (Eigen::Index j = 0; j < efforts_; ++j) B_(actuated_[static_cast<std::size_t>(j)], j) = 1;
    for (Eigen::Index c = 0; c < couplings; ++c) {
      for (const NamedNumber& term : scene.couplings[static_cast<std::size_t>(c)].terms) {
        const Joint& joint = mechanism.joint(mechanism.jointIndex(term.name));
        B_(joint.coordinate, efforts_ + c) +=
            static_cast<long double>(term.value) * joint.multiplier;
      }
    }
    const std::vector<long double> efforts = bodies_.efforts();
    tau_ = Eigen::Map<const VectorXl>(efforts.data(), n);
    const Eigen::JacobiSVD<MatrixXl> svd(B_, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const VectorXl& sizes = svd.singularValues();
    while (rank_ < sizes.size() && sizes[rank_] > 1e-11L * sizes[0]) ++rank_;
    if (rank_ > 0) condition_ = sizes[0] / sizes[rank_ - 1];
    changes_ = svd.matrixV().rightCols(B_.cols() - rank_);
    x_ = B_.completeOrthogonalDecomposition().solve(tau_);
  }

  bool holds() const { return rank_ == B_.rows(); }
  // Whether a coupling says no more than mimic joints do.
  bool repeatsMimics() const {
    for (Eigen::Index c = efforts_; c < B_.cols(); ++c) {
      if (B_.col(c).isZero(1e-15L)) return true;
    }
    return false;
  }
  Eigen::Index redundancy() const { return B_.cols() - rank_; }
  double condition() const { return static_cast<double>(condition_); }
  bool determined(Eigen::Index unknown) const {
    return changes_.cols() == 0 || changes_.row(unknown).norm() <= kNoChange;
  }
  double operator[](Eigen::Index unknown) const { return static_cast<double>(x_[unknown]); }
  Eigen::Index efforts() const { return efforts_; }
  const std::vector<Eigen::Index>& actuated() const { return actuated_; }
  const NewtonEulerOracle& bodies() const { return bodies_; }
  // What efforts, by coordinate, and couplings' efforts leave of the equations.
  double miss(const Eigen::VectorXd& found) const {
    VectorXl x(B_.cols());
    for (Eigen::Index j = 0; j < efforts_; ++j)
      x[j] = found[actuated_[static_cast<std::size_t>(j)]];
    x.tail(B_.cols() - efforts_) = found.tail(B_.cols() - efforts_).cast<long double>();
    return static_cast<double>((B_ * x - tau_).norm());
  }
  double size() const { return static_cast<double>(std::max(x_.norm(), tau_.norm())); }

 private:
  static Scene treeOf(Scene scene) {
    scene.couplings.clear();
    scene.actuated.reset();
    return scene;
  }

  NewtonEulerOracle bodies_;
  std::vector<Eigen::Index> actuated_;
  Eigen::Index efforts_ = 0, rank_ = 0;
  long double condition_ = 1;
  MatrixXl B_, changes_;
  VectorXl tau_, x_;
};

// Trees of random_cases.h with couplings, some of which say what others say.
Case withCouplings(RandomCases& random) {
  Case made = random.next(3 + random.pick(8));
  while (made.mechanism.coordinates().size() < 2) made = random.next(3 + random.pick(8));
  Scene& scene = made.scene;
  scene.reactions = ReactionSelection::kAll;
  scene.reaction_names.clear();
  scene.include_active = true;
  scene.use_urdf_dynamics = false;
  scene.joints.clear();
  std::vector<std::string> moving;
  for (const Joint& joint : made.mechanism.joints()) {
    if (joint.coordinate >= 0) moving.push_back(joint.name);
  }
  for (int c = 0, count = 1 + random.pick(4); c < count; ++c) {
    Coupling coupling;
    coupling.name = "coupling " + std::to_string(c);
    if (c > 0 && random.chance(0.2)) {
      coupling.terms = scene.couplings[0].terms;
      for (NamedNumber& term : coupling.terms) term.value *= -2;
    } else {
      std::vector<std::string> left = moving;
      for (int t = 0, terms = 1 + random.pick(3); t < terms && !left.empty(); ++t) {
        const auto at = left.begin() + random.pick(static_cast<int>(left.size()));
        coupling.terms.push_back({*at, random.chance(0.3) ? 1.0 : random.uniform(0.2, 3)});
        left.erase(at);
      }
    }
    coupling.rate_only = random.chance(0.2);
    scene.couplings.push_back(coupling);
  }
  scene.actuated = std::vector<std::string>();
  for (const std::string& name : made.mechanism.coordinateNames()) {
    if (random.chance(0.7)) scene.actuated->push_back(name);
  }
  for (std::size_t i = 0; i < made.mechanism.coordinates().size(); ++i) {
    scene.assembly.push_back(
        {made.mechanism.coordinateNames()[i], made.motion.q[static_cast<Eigen::Index>(i)]});
  }
  return made;
}

class RandomCouplings : public testing::Test {
 protected:
  void check(const Case& made, const CouplingsOracle& oracle) {
    const ClosedLoopResults found(made.mechanism, made.scene, made.motion);
    const Eigen::VectorXd& effort = found.dynamics.effort();
    const std::vector<bool>& determined = found.dynamics.effortDetermined();
    const double tolerance =
        kPerCondition * oracle.condition() * oracle.condition() * std::max(1.0, oracle.size());
    EXPECT_EQ(found.dynamics.determinacy().redundancy, oracle.redundancy());
    EXPECT_LE(oracle.miss(effort), tolerance);
    const auto compare = [&](Eigen::Index at, Eigen::Index unknown) {
      ASSERT_TRUE(std::isfinite(effort[at]));
      EXPECT_EQ(determined[static_cast<std::size_t>(at)], oracle.determined(unknown)) << at;
      if (!oracle.determined(unknown)) return;
      ++compared_;
      EXPECT_NEAR(effort[at], oracle[unknown], tolerance);
    };
    for (Eigen::Index j = 0; j < oracle.efforts(); ++j) {
      compare(oracle.actuated()[static_cast<std::size_t>(j)], j);
    }
    const Eigen::Index n = found.dynamics.coordinates();
    for (Eigen::Index c = 0; c < effort.size() - n; ++c) compare(n + c, oracle.efforts() + c);
    // Reactions are those of the tree.
    for (std::size_t k = 0; k < made.mechanism.joints().size(); ++k) {
      const Joint& joint = made.mechanism.joints()[k];
      if (joint.type == JointType::kFixed) continue;
      const NewtonEulerOracle::RootWrench expected = oracle.bodies().reaction(static_cast<int>(k));
      const Wrench& wrench = found.root(joint.name);
      const double size = std::max(1.0, oracle.size());
      EXPECT_LE((wrench.force - expected.force.cast<double>()).norm(),
                1e-11 * std::max(size, static_cast<double>(expected.force.norm())));
      EXPECT_LE((wrench.torque - expected.torque.cast<double>()).norm(),
                1e-11 * std::max(size, static_cast<double>(expected.torque.norm())));
    }
  }

  int compared_ = 0;
};

TEST_F(RandomCouplings, AgreeWithTheNullSpace) {
  RandomCases random(17);
  int solved = 0, refused = 0, open = 0;
  for (int i = 0; i < 600; ++i) {
    SCOPED_TRACE("case " + std::to_string(i));
    const Case made = withCouplings(random);
    const CouplingsOracle oracle(made.mechanism, made.scene, made.motion);
    if (oracle.condition() > 1e4) continue;
    if (oracle.repeatsMimics() || !oracle.holds()) {
      ++refused;
      EXPECT_THROW(ClosedLoopResults(made.mechanism, made.scene), SceneError);
      continue;
    }
    ++solved;
    if (oracle.redundancy() > 0) ++open;
    check(made, oracle);
  }
  EXPECT_GE(solved, 150);
  EXPECT_GE(open, 50);
  EXPECT_GE(refused, 50);
  EXPECT_GE(compared_, 500);
}

}  // namespace
}  // namespace virtual_work_dynamics
