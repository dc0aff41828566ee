#include "core/loop_forces.h"

#include <algorithm>
#include <cmath>

namespace virtual_work_dynamics {

namespace {

// What of the load may point along a free motion and count as rounding, of the whole load.
constexpr double kBorne = 1e-9;
// Entries of a free motion, a unit vector, below which a coordinate does not take part in it.
constexpr double kTakesPart = 1e-6;

Eigen::Index index(std::size_t i) {
  return static_cast<Eigen::Index>(i);
}

Eigen::Index unknownsOf(const LoopKinematics& kinematics, const LoopScene& scene,
                        const LoopGroup& group) {
  Eigen::Index count = 0;
  for (const int i : group.coordinates) count += scene.actuated[static_cast<std::size_t>(i)];
  for (const std::size_t c : group.closures) {
    count += kinematics.firstOf(c + 1) - kinematics.firstOf(c);
    count += std::count(scene.actuated_closures.begin(), scene.actuated_closures.end(), c);
  }
  return count;
}

// Costs are of all unknowns, or of whole reactions.
Eigen::Index mostCosts(const LoopGroup& group, Eigen::Index unknowns) {
  return std::max(unknowns, index(6 * (group.closures.size() + group.joints.size())));
}

}  // namespace

LoopForces::LoopForces(const Mechanism& mechanism, const LoopKinematics& kinematics,
                       const LoopScene& scene, const LoopGroup& group, double length)
    : kinematics_(kinematics),
      group_(group),
      rank_tolerance_(scene.rank_tolerance),
      length_(length),
      G_(index(group.coordinates.size()), unknownsOf(kinematics, scene, group)),
      G_transposed_(G_.cols(), G_.rows()),
      factorization_(G_.rows(), G_.cols()),
      transposed_(G_.cols(), G_.rows()),
      norms_(G_.cols(), mostCosts(group, G_.cols())),
      load_(G_.rows()),
      gathered_(scene.start.size()),
      directions_(G_.cols(), G_.cols() + G_.rows()) {
  addColumns(mechanism, scene);
  addCosts(scene);
  for (State* state : {&solution_, &change_}) {
    state->x.setZero(G_.cols());
    state->closures.resize(group_.closures.size());
  }
}

void LoopForces::addColumns(const Mechanism& mechanism, const LoopScene& scene) {
  for (std::size_t row = 0; row < group_.coordinates.size(); ++row) {
    const std::size_t i = static_cast<std::size_t>(group_.coordinates[row]);
    const int joint = mechanism.coordinates()[i];
    const bool slides =
        mechanism.joints()[static_cast<std::size_t>(joint)].type == JointType::kPrismatic;
    row_units_.push_back(slides ? 1 : length_);
    if (!scene.actuated[i]) continue;
    effort_rows_.push_back(index(row));
    efforts_.push_back({i, row_units_.back() / std::sqrt(scene.coordinate_weights[i])});
  }
  for (std::size_t n = 0; n < scene.actuated_closures.size(); ++n) {
    const std::size_t c = scene.actuated_closures[n];
    const auto found = std::find(group_.closures.begin(), group_.closures.end(), c);
    if (found == group_.closures.end()) continue;
    const bool slides = kinematics_.unitEffort(c).force.squaredNorm() > 0;
    const double unit = (slides ? 1 : length_) / std::sqrt(scene.closure_weights[c]);
    efforts_.push_back({scene.actuated.size() + n, unit});
    columns_.push_back({static_cast<std::size_t>(found - group_.closures.begin()), -1, unit});
  }
  for (std::size_t local = 0; local < group_.closures.size(); ++local) {
    const std::size_t c = group_.closures[local];
    for (Eigen::Index i = kinematics_.firstOf(c); i < kinematics_.firstOf(c + 1); ++i) {
      columns_.push_back({local, i, kinematics_.turns(i) ? length_ : 1});
    }
  }
  unit_wrenches_.resize(columns_.size());
}

void LoopForces::addCosts(const LoopScene& scene) {
  for (const std::size_t c : group_.closures) {
    const double factor = scene.policy == RedundancyPolicy::kStiffness
                              ? 1 / std::sqrt(scene.closure_stiffness[c])
                              : scene.policy == RedundancyPolicy::kZeroAt && scene.zero_at[c];
    closure_costs_.push_back(factor);
    if (factor > 0) cost_rows_ += 6;
  }
  for (const LoopGroup::CrossedJoint& crossed : group_.joints) {
    const double factor =
        scene.policy == RedundancyPolicy::kStiffness && crossed.moves
            ? 1 / std::sqrt(scene.joint_stiffness[static_cast<std::size_t>(crossed.joint)])
            : 0;
    joint_costs_.push_back(factor);
    if (factor > 0) cost_rows_ += 6;
  }
  // Only their ratios matter: the largest is made one, as costs are compared with unit vectors.
  double largest = 0;
  for (const double factor : closure_costs_) largest = std::max(largest, factor);
  for (const double factor : joint_costs_) largest = std::max(largest, factor);
  for (double& factor : closure_costs_) factor /= largest > 0 ? largest : 1;
  for (double& factor : joint_costs_) factor /= largest > 0 ? largest : 1;
}

void LoopForces::setPosition() {
  G_.setZero();
  for (std::size_t j = 0; j < effort_rows_.size(); ++j) {
    G_(effort_rows_[j], index(j)) = efforts_[j].unit / row_units_[std::size_t(effort_rows_[j])];
  }
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    const Column& column = columns_[j];
    const std::size_t c = group_.closures[column.closure];
    ClosureWrench& wrench = unit_wrenches_[j];
    wrench =
        column.condition < 0 ? kinematics_.unitEffort(c) : kinematics_.unitWrench(column.condition);
    wrench.force *= column.unit;
    wrench.moment *= column.unit;
    for (const int i : group_.coordinates) gathered_[i] = 0;
    kinematics_.addGeneralizedForce(c, wrench, gathered_);
    for (Eigen::Index row = 0; row < G_.rows(); ++row) {
      G_(row, index(effort_rows_.size() + j)) =
          gathered_[group_.coordinates[std::size_t(row)]] / row_units_[std::size_t(row)];
    }
  }
  factorization_.factorize(G_, rank_tolerance_);
  if (rank() == coordinates()) return;
  G_transposed_ = G_.transpose();
  transposed_.factorize(G_transposed_, rank_tolerance_);
}

bool LoopForces::isFree(Eigen::Index local) const {
  return rank() < coordinates() && transposed_.nullSpace().row(local).norm() > kTakesPart;
}

void LoopForces::solve(const Eigen::VectorXd& tree_effort,
                       const std::vector<Wrench>& tree_reactions) {
  for (Eigen::Index row = 0; row < G_.rows(); ++row) {
    load_[row] = tree_effort[group_.coordinates[std::size_t(row)]] / row_units_[std::size_t(row)];
  }
  bearLoad();
  factorization_.solve(load_, solution_.x);
  direction_count_ = factorization_.redundancy();
  directions_.leftCols(direction_count_) = factorization_.nullSpace();
  choose(tree_reactions);
  setClosures(solution_);
  if (!bears_) addOpenLoads();
}

// Takes from the load what points along a free motion: nothing bears it.
void LoopForces::bearLoad() {
  bears_ = true;
  if (rank() == coordinates()) return;
  const double load = load_.norm();
  for (Eigen::Index j = 0; j < transposed_.redundancy(); ++j) {
    const auto motion = transposed_.nullSpace().col(j);
    const double along = motion.dot(load_);
    load_ -= along * motion;
    if (!(std::abs(along) <= kBorne * load)) bears_ = false;
  }
}

// What a unit load on a coordinate that takes part in a free motion changes; loads of coordinates
// that depend on others follow and add nothing new.
void LoopForces::addOpenLoads() {
  for (Eigen::Index row = 0; row < coordinates(); ++row) {
    if (!isFree(row)) continue;
    load_.setZero();
    load_[row] = 1;
    factorization_.solve(load_, change_.x);
    const double norm = change_.x.norm();
    if (norm > 0) directions_.col(direction_count_++) = change_.x / norm;
  }
}

void LoopForces::choose(const std::vector<Wrench>& tree_reactions) {
  norms_.start(factorization_.nullSpace());
  redundant_constraints_ = norms_.open();
  if (norms_.open() == 0) return;
  const Eigen::Index efforts = index(efforts_.size());
  norms_.costs(efforts) = norms_.space().topRows(efforts);
  norms_.costOfSolution(efforts) = solution_.x.head(efforts);
  redundant_constraints_ -= norms_.reduce(efforts, solution_.x);
  if (norms_.open() > 0 && cost_rows_ > 0) {
    setClosures(solution_);
    putCosts(solution_, &tree_reactions, norms_.costOfSolution(cost_rows_));
    for (Eigen::Index j = 0; j < norms_.open(); ++j) {
      change_.x = norms_.space().col(j);
      setClosures(change_);
      putCosts(change_, nullptr, norms_.costs(cost_rows_).col(j));
    }
    norms_.reduce(cost_rows_, solution_.x);
  }
  norms_.finish(solution_.x);
}

void LoopForces::putCosts(const State& state, const std::vector<Wrench>* tree_reactions,
                          Eigen::Ref<Eigen::VectorXd> costs) const {
  Eigen::Index row = 0;
  const auto put = [&](const ClosureWrench& wrench, double factor) {
    costs.segment<3>(row) = factor * wrench.force;
    costs.segment<3>(row + 3) = factor / length_ * wrench.moment;
    row += 6;
  };
  for (std::size_t c = 0; c < closure_costs_.size(); ++c) {
    if (closure_costs_[c] > 0) put(state.closures[c], closure_costs_[c]);
  }
  for (std::size_t k = 0; k < joint_costs_.size(); ++k) {
    if (joint_costs_[k] == 0) continue;
    ClosureWrench wrench = jointWrench(group_.joints[k], state);
    if (tree_reactions) {
      const Wrench& own = (*tree_reactions)[static_cast<std::size_t>(group_.joints[k].joint)];
      wrench.force += own.force;
      wrench.moment += own.torque;
    }
    put(wrench, joint_costs_[k]);
  }
}

const LoopForces::State& LoopForces::direction(Eigen::Index i) {
  change_.x = directions_.col(i);
  setClosures(change_);
  return change_;
}

void LoopForces::setClosures(State& state) const {
  for (ClosureWrench& wrench : state.closures) wrench = {};
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    ClosureWrench& wrench = state.closures[columns_[j].closure];
    const double amount = state.x[index(effort_rows_.size() + j)];
    wrench.force += amount * unit_wrenches_[j].force;
    wrench.moment += amount * unit_wrenches_[j].moment;
  }
}

// Where a closure bears a link, the joints behind that link need not.
ClosureWrench LoopForces::jointWrench(const LoopGroup::CrossedJoint& crossed,
                                      const State& state) const {
  ClosureWrench sum;
  const Eigen::Vector3d& origin = kinematics_.originOf(crossed.joint + 1);
  for (const LoopGroup::Passage& passage : crossed.passages) {
    const ClosureWrench& wrench = state.closures[passage.closure];
    const Eigen::Vector3d lever =
        kinematics_.childOrigin(group_.closures[passage.closure]) - origin;
    sum.force -= passage.sign * wrench.force;
    sum.moment -= passage.sign * (wrench.moment + lever.cross(wrench.force));
  }
  return sum;
}

}  // namespace virtual_work_dynamics
