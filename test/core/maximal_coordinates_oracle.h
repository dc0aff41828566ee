#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "loop_geometry.h"
#include "newton_euler_oracle.h"

namespace virtual_work_dynamics {

/// Computes reactions of a mechanism with closures by cutting every joint. All six components of
/// the wrench in each joint, in each closure and on the root link are unknown. The equations are
/// the balances of force and moment of every link; and a free direction of a closure or a passive
/// coordinate carries only its joints' springs and friction, and what couplings exert on it, whose
/// efforts are unknown as well. They are one linear system in numbers
/// of type Real, solved with its null space by Gauss with full pivoting; motion and loads of the
/// links are in long double. Teeth bear with the flank that the solution asks for. There is no tree
/// recursion, no Jacobian of conditions and no multiplier.
template <typename Real>
class MaximalCoordinates {
 public:
  using Vector6 = Eigen::Matrix<Real, 6, 1>;
  using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
  using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
  using Matrix3 = Eigen::Matrix<Real, 3, 3>;

  // Least pivot that counts, relative to the largest; those of dependent equations are rounding
  // errors, 1e-18 in long double and 1e-15 in double.
  static constexpr Real kPivot = sizeof(Real) > sizeof(double) ? Real(1e-13L) : Real(1e-11L);
  // A component is determined when no null vector, orthonormal in newtons, changes it by more.
  static constexpr Real kFree = Real(1e-8L);

  /// Solves the equations.
  /// @param pivot_tolerance pivots above it, relative to the largest, count for the rank.
  MaximalCoordinates(const Mechanism& mechanism, const Scene& scene, const Motion& motion,
                     Real pivot_tolerance = kPivot);

  /// Unknowns less rank.
  Eigen::Index redundancy() const { return N_.cols(); }
  /// Equations less rank: the number of motions that nothing holds.
  Eigen::Index freeMotions() const { return G_.rows() - (G_.cols() - redundancy()); }
  /// The least pivot that counts for the rank, over the largest pivot of all.
  Real leastCounted() const { return least_counted_; }
  /// The largest pivot that does not count for the rank, over the largest pivot of all.
  Real largestLeftOut() const { return largest_left_out_; }
  /// The largest violation of an equation by the solution, relative to the largest load or 1 N.
  Real residual() const { return violation(x_); }
  /// The largest distance of loops, of their joints and of the frames of closures, from the root's
  /// origin, over the length that moments are compared with forces by, which counts all joints and
  /// centres of mass.
  Real sizeOfLoops() const;
  /// That length, m.
  long double length() const { return length_; }
  /// The largest share of the loads' work along a motion that nothing holds, which nothing bears:
  /// the sum of the works of all balances over the sum of their magnitudes; 0 without such a
  /// motion. It does not depend on loads elsewhere.
  Real unborne() const;

  struct Reaction {
    Vector6 wrench;  ///< force, moment; one of many solutions where it is not determined
    std::array<bool, 6> determined;
    std::array<Real, 6> freedom;  ///< by how much null vectors change it, a moment over length()
  };
  /// The reaction of a joint, a closure or "ground" in root axes.
  Reaction rootAxes(const std::string& name) const;
  /// The reaction in axes of the child link or of a closure's child frame.
  Reaction childAxes(const std::string& name) const;

  /// The reaction in root axes, or in child axes, with its moment about another point, root axes;
  /// of a root that rests.
  Reaction rootAxesAbout(const std::string& name, const Vector3l& point) const;
  Reaction childAxesAbout(const std::string& name, const Vector3l& point) const;

  /// Whether a component in root axes is determined by the criterion of M. Wojtyra, "Joint reaction
  /// forces in multibody systems with redundant constraints", Multibody System Dynamics 14 (2005):
  /// it is determined when the rank drops without it.
  bool rankDropsWithout(const std::string& name, int i) const;

  struct Effort {
    Real value;
    bool determined;
    Real freedom;  ///< by how much null vectors change it, a torque over the length
  };
  /// The effort of a generalized coordinate, or of an actuated closure by its name.
  Effort effort(int coordinate) const;
  Effort closureEffort(const std::string& name) const;
  /// The effort of a coupling of the scene.
  Effort couplingEffort(std::size_t coupling) const;

  /// By how much reactions of every joint, "ground" and closure, in root axes, violate the
  /// equations, relative to the largest load or 1 N. It is small for any one of many solutions.
  Real violationBy(const std::function<Wrench(const std::string&)>& wrench_of) const;

 private:
  struct Cut {
    std::string name;
    int parent, child;  // links; parent -1: ground
    Vector3l o;         // point about which the moment is taken
    Matrix3l R;         // child axes
    Vector3l reported;  // point about which the moment is reported
  };

  static Scene withoutLoops(Scene scene);

  static Eigen::Index at(std::size_t cut) { return 6 * static_cast<Eigen::Index>(cut); }

  void place();

  // Makes and solves the equations.
  void setUp(const Motion& motion);

  // Whether other flanks bear teeth than those the equations count with, which they then do.
  bool turnsFlanks();

  std::size_t indexOf(const std::string& name) const;

  // The largest distance of a closure's frames and the joints of its loop from the root's origin.
  long double reachOf(const Closure& closure) const;

  static Matrix3l cross(const Vector3l& r);

  // The balances of force, and of moment about the centre of mass over the length, of every link.
  void addBalances();

  void load(int link, const Vector3l& point, const Vector3l& force);

  void addRow(const Vector& row, Real value);

  void addFree(std::size_t cut, bool moment, const Vector3l& direction);

  bool actuated(const std::string& name) const;

  void addFreeDirections(std::size_t c);

  void addTeeth(std::size_t c);

  // The column of a coupling's effort, and what that counts in N.
  Eigen::Index columnOf(std::size_t coupling) const {
    return at(cuts_.size()) + static_cast<Eigen::Index>(coupling);
  }
  long double unitOf(std::size_t coupling) const;

  // The row that sums what the joints of a coordinate carry along their axes, as they mimic it,
  // less what couplings exert on them.
  Vector effortRow(int coordinate) const;

  // Adds the equations of passive coordinates, which have no effort other than springs, friction
  // and rotors of the scene's terms.
  void addPassiveCoordinates(const Motion& motion);

  Eigen::Index rankOf(const Matrix& matrix) const;

  void solve();

  Real violation(const Vector& x) const;

  Real freedom(const Vector& row) const;

  Effort effort(const Vector& row, Real terms) const;

  // `lever` leads to the point of the unknown moment from that of the moment that is wanted.
  Reaction reaction(const std::string& name, const Matrix3l& axes,
                    const Vector3l& lever = Vector3l::Zero()) const;

  const Mechanism& mechanism_;
  const Scene& scene_;
  NewtonEulerOracle bodies_;
  std::vector<Cut> cuts_;          // joints, ground, closures
  std::vector<bool> other_flank_;  // by closure
  long double length_ = 0;
  Real pivot_tolerance_, least_counted_ = 1, largest_left_out_ = 0;
  Eigen::Index rows_ = 0;
  Matrix G_, N_;
  Vector b_, x_;
  std::vector<long double> terms_;  // effort by joint terms of each coordinate
};

extern template class MaximalCoordinates<double>;
extern template class MaximalCoordinates<long double>;
using MaximalCoordinatesOracle = MaximalCoordinates<long double>;

}  // namespace virtual_work_dynamics
