#pragma once

#include <Eigen/Core>
#include <vector>

#include "algebra/multifrontal_qr.h"
#include "loops/groups.h"
#include "loops/kinematics.h"
#include "loops/rank.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"

namespace virtual_work_dynamics {

/// Finds the coordinates that a motion does not give from the conditions of the loops: positions by
/// Newton's method, velocities by A_p qd_p = -(A_g qd_g + b), accelerations by A_p qdd_p = -(A_g
/// qdd_g + Ad qd + bd), where p are the coordinates to be found and g those that are given. A
/// coordinate stays where the motion has it unless a condition with a position level moves it. Far
/// from singular positions the cost grows with the number of loops; elsewhere with the cube of
/// those that share coordinates. Nothing after construction allocates.
class LoopCompletion {
 public:
  /// `length`, m, makes lengths comparable with angles.
  LoopCompletion(const Mechanism& mechanism, const LoopKinematics& kinematics,
                 const std::vector<LoopGroup>& groups, double rank_tolerance, double length);

  /// How far a search goes before it fails. A search from a position close by gives up early, so
  /// that loops that cannot be closed cost little more than loops that can.
  struct Search {
    int most_steps;
    int most_halvings;  ///< of a step
    double stalled;     ///< largest share of the misfit that a step may leave
  };
  static constexpr Search kFromAnywhere{200, 30, 1};
  static constexpr Search kFromCloseBy{40, 8, 0.9};

  /// Closes the loops by moving the coordinates that are not given, from where they are; leaves
  /// `kinematics` at the position found. Returns false when that fails, with `q` at the best
  /// position met.
  bool close(LoopKinematics& kinematics, Eigen::VectorXd& q, const std::vector<bool>& given,
             const Search& search = kFromAnywhere);

  double length() const { return length_; }
  std::vector<LoopGroup> groups() const;
  /// By coordinate: 1, or the length for slides.
  const std::vector<double>& scales() const { return column_scales_; }
  /// How far the loops are open, without units.
  double misfit(const LoopKinematics& kinematics) const;
  /// Largest entry of coordinates in loops, with lengths divided by length().
  double largest(const Eigen::VectorXd& rates) const;
  /// Number of steps that close() took.
  int steps() const { return steps_; }

  /// Closes the loops as close() does, and finds velocities and accelerations, too. Returns false
  /// also when no rates meet the conditions, or when the conditions do not determine them, as in
  /// singular positions and outside loops.
  bool complete(LoopKinematics& kinematics, Motion& motion, const std::vector<bool>& given,
                const Search& search = kFromAnywhere);

  /// Rank of the Jacobian of the conditions that have a position for the coordinates that are not
  /// given, summed over all groups.
  Eigen::Index rank(const LoopKinematics& kinematics, const std::vector<bool>& given);
  /// That of all conditions, also of those that tie rates alone.
  Eigen::Index rankOfRates(const LoopKinematics& kinematics, const std::vector<bool>& given);
  /// Whether the conditions determine the coordinates that are not given at the present position,
  /// as complete() demands it.
  bool determine(const LoopKinematics& kinematics, const std::vector<bool>& given);

 private:
  // The Jacobian of one group's conditions, with lengths divided by length().
  struct System {
    System(const Mechanism& mechanism, const LoopKinematics& kinematics, const LoopGroup& group,
           double rank_tolerance, double length);
    LoopGroup group;
    MultifrontalQr qr;    // of the columns to be found
    LoopRank rank;        // of these columns, where qr is no factorization
    bool square = false;  // whether as many rows can have entries as columns are to be found
    std::vector<bool> wanted;
    /// Coordinates to be found that the rows of a set have entries for.
    struct Entries {
      std::vector<ScaledColumn> columns;
      std::vector<int> places;  ///< of these coordinates in the group
    };
    std::vector<Entries> entries;  ///< by set, as the group counts them
    struct Found {
      int place, coordinate;
      double scale;  ///< of its column
      bool bends;    ///< see LoopKinematics::bends()
    };
    std::vector<Found> found;  ///< all coordinates to be found
    struct Conditions {
      Eigen::Index first, count;
    };
    std::vector<Conditions> conditions;  ///< those of its sets, in their order
    std::vector<bool> bends;             // by place
    bool sound = false;                  // whether qr is a factorization
  };
  void want(const std::vector<bool>& given);
  // Rows whose scale is zero count as absent.
  void setEntries(const LoopKinematics& kinematics, const Eigen::VectorXd& row_scales);
  void factorize(const LoopKinematics& kinematics, const Eigen::VectorXd& row_scales);
  Eigen::Index rankBy(const Eigen::VectorXd& row_scales, const LoopKinematics& kinematics,
                      const std::vector<bool>& given);
  void setRight(const System& system, const Eigen::VectorXd& conditions);
  // Finds the largest condition, with lengths divided by length().
  double largestCondition(const Eigen::VectorXd& conditions) const;
  bool solve(System& system);
  double misses(const System& system);
  bool refine(System& system);
  bool isMet(const System& system, double size);
  double solveSteps(const Eigen::VectorXd& conditions, double longest, Eigen::VectorXd& step);
  double bendStep(LoopKinematics& kinematics);
  double tryStep(LoopKinematics& kinematics, const Eigen::VectorXd& q, double now, bool bent,
                 int halvings);
  bool sound() const;
  bool solveRates(const Eigen::VectorXd& rates, double size, Eigen::VectorXd& unknown);
  bool findRates(LoopKinematics& kinematics, Motion& motion);
  double columnScale(int coordinate) const {
    return column_scales_[static_cast<std::size_t>(coordinate)];
  }

  std::vector<System> systems_;
  const LoopFunctions* kernel_;
  std::vector<bool> given_;  // by coordinate; those of want()
  double rank_tolerance_;
  double length_;
  // By condition: the factor that makes it an angle; in position_scales_ zero where it has no
  // position.
  Eigen::VectorXd row_scales_, position_scales_;
  std::vector<double> column_scales_;  // by coordinate
  std::vector<bool> in_loop_;          // by coordinate
  int steps_ = 0;
  // Whether the factorizations are those of a position so close by that refining what they give
  // costs less than factorizing.
  bool close_by_ = false;
  Eigen::VectorXd right_, found_, misses_, refined_;  // of the group being solved
  Eigen::VectorXd step_, bend_, tried_;               // by coordinate; bend_: twice c of a step
  double step_length_ = 0;           // largest entry of step_, rad or over the length
  double share_ = 1;                 // of a step that was gone
  double exact_ = 0, rounding_ = 0;  // misfits: see completion.cpp
  bool all_places_ = true;           // whether all conditions have a position
  bool determinable_ = true;         // whether all coordinates to be found are in loops
  bool refines_ = true;              // whether refining costs less than factorizing
};

}  // namespace virtual_work_dynamics
