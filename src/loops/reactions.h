#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "loops/forces.h"
#include "loops/kinematics.h"
#include "scene/moment_points.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/results.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Requested reactions: those of the tree and those of closures put together in the request's
/// order, and which of their components are determined. Nothing after construction allocates.
class LoopReactions {
 public:
  /// @param groups must outlive it and its copies
  /// @param points of moments; none: all moments are about the child frames' origins
  /// @param axes those in which reactions are reported
  /// @throws SceneError for a name that is neither a joint nor a closure, or that is given twice.
  LoopReactions(const Mechanism& mechanism, const Scene& scene, const LoopScene& loops,
                const std::vector<LoopGroup>& groups, const std::vector<std::string>& names,
                const MomentPoints* points, Axes axes);

  /// As kernels see them; what they add to the reactions of the open tree, in the order of
  /// treeRequest(), is what closures do on the joints of loops.
  ReactionsView view() const {
    return {shapes_.data(), passages_.data(), static_cast<int>(shapes_.size()), child_axes_};
  }
  /// Sets the poses of the joints' frames and of the closures' child frames, at the points of their
  /// moments.
  /// @param tree those of joints and ground, in the order of treeRequest()
  void setPoses(const LoopKinematics& kinematics, const std::vector<Pose>& tree,
                std::vector<Pose>& poses) const;
  /// Sets their twists.
  /// @param tree those of joints and ground, in the order of treeRequest()
  void setTwists(const LoopKinematics& kinematics, const std::vector<Twist>& tree,
                 std::vector<Twist>& twists) const;

  /// Starts anew. Flags follow from the changes that mechanics leaves open: call reset(), then
  /// addChange() with each change of each group, then setFlags().
  void reset();
  void addChange(const LoopKinematics& kinematics, std::size_t group, const LoopForces& forces,
                 const LoopForces::State& change);
  /// What a change makes of a reaction as it is reported.
  struct Changed {
    std::size_t item;
    std::array<double, 6> by;
  };
  /// Gets how a change of a group alters reactions; others stay. Does not allocate where `changed`
  /// has room for size().
  void getChanged(const LoopKinematics& kinematics, std::size_t group, const LoopForces& forces,
                  const LoopForces::State& change, std::vector<Changed>& changed);
  /// Also once for each group that does not bear its load: what no multiplier balances is left to
  /// joints that move freely, as an effort that they do not have.
  void addUnborne(const LoopKinematics& kinematics, std::size_t group, const LoopForces& forces);
  void setFlags(std::vector<Determined>& determined) const;

  /// Starts anew. How many dimensions the changes of each wrench span, whatever the axes, follows
  /// from the same changes: call resetSpans(), then addSpan() with each of them, then getRanks().
  void resetSpans();
  void addSpan(const LoopKinematics& kinematics, std::size_t group, const LoopForces& forces,
               const LoopForces::State& change);
  /// As addUnborne().
  void addUnborneSpan(const LoopKinematics& kinematics, std::size_t group,
                      const LoopForces& forces);
  void getRanks(std::vector<int>& ranks) const;

  std::size_t size() const { return items_.size(); }

 private:
  struct Item {
    int joint = -1;                              ///< -1 for ground or a closure
    int closure = -1;                            ///< -1 for what the tree has
    std::optional<CompoundJoint> compound;       ///< that the joint is the last part of
    std::optional<LinkKinematics::Frame> point;  ///< of the moment, where it is not the origin
  };
  /// An item that a group of loops can change.
  struct Change {
    std::size_t item;
    const LoopGroup::CrossedJoint* crossed;  ///< null for a closure
    std::size_t closure;                     ///< index into the group's
    std::size_t counted = 0;                 ///< number of the change that was visited last
  };
  template <typename Visit>
  void visitChanged(std::size_t group, const LoopForces& forces, const LoopForces::State& change,
                    Visit visit);
  void setPoint(const MomentPoints& points);
  void addClosure(const Scene& scene, const LoopScene& loops, std::size_t closure);
  void addJoint(const Mechanism& mechanism, const Scene& scene, const std::string& name);
  void addPassages(const std::vector<LoopGroup>& groups);
  static Eigen::Vector3d originOf(const LoopKinematics& kinematics, const Item& item);
  static Eigen::Vector3d leverOf(const LoopKinematics& kinematics, const Item& item);
  template <typename Visit>
  void visitUnborne(const LoopKinematics& kinematics, std::size_t group, const LoopForces& forces,
                    Visit visit);
  void addSpanOf(const LoopKinematics& kinematics, std::size_t item, const LoopForces& forces,
                 const ClosureWrench& wrench);
  void addChanges(const std::vector<LoopGroup>& groups);
  void addChangeOf(const LoopKinematics& kinematics, std::size_t item, const LoopForces& forces,
                   const ClosureWrench& wrench);

  const LoopFunctions* kernel_;
  bool child_axes_;
  std::vector<Item> items_;
  std::vector<ReactionShape> shapes_;         // by item
  std::vector<PassageShape> passages_;        // of all closures through each joint
  std::vector<std::vector<Change>> changes_;  // by group
  // changes_of_[g][c]: indices into changes_[g] of the items that closure c of group g affects.
  std::vector<std::vector<std::vector<std::size_t>>> changes_of_;
  std::size_t calls_ = 0;                           // number of changes visited
  std::vector<std::array<double, 6>> freedoms_;     // sums of squared changes over leastChange()
  std::vector<Eigen::Matrix<double, 6, 6>> spans_;  // sums of products of changes
};

}  // namespace virtual_work_dynamics
