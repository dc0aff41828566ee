#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "loop_geometry.h"
#include "newton_euler_oracle.h"

namespace virtual_work_dynamics {

/// Computes reactions of a mechanism with closures by cutting every joint. All six components of
/// the wrench in each joint, in each closure and on the root link are unknown. The equations are
/// the balances of force and moment of every link; and a free direction of a closure or a passive
/// coordinate carries only its joints' springs and friction. They are one linear system in numbers
/// of type Real, solved with its null space by Gauss with full pivoting; motion and loads of the
/// links are in long double. There is no tree recursion, no Jacobian of conditions and no
/// multiplier.
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
                     Real pivot_tolerance = kPivot)
      : mechanism_(mechanism),
        scene_(scene),
        bodies_(mechanism, withoutLoops(scene), motion),
        pivot_tolerance_(pivot_tolerance) {
    for (std::size_t k = 0; k < mechanism.joints().size(); ++k) {
      const int child = mechanism.joints()[k].child_link;
      cuts_.push_back({mechanism.joints()[k].name, mechanism.joints()[k].parent_link, child,
                       bodies_.origin(child), bodies_.orientation(child)});
    }
    cuts_.push_back({kGround, -1, 0, bodies_.origin(0), bodies_.orientation(0)});
    for (const Closure& closure : scene.closures) {
      const PlacedFrame frame(mechanism, bodies_, closure.child);
      cuts_.push_back({closure.name, mechanism.linkIndex(closure.parent.link),
                       mechanism.linkIndex(closure.child.link), frame.o, frame.R});
    }
    for (const Cut& cut : cuts_) length_ = std::max(length_, (cut.o - bodies_.origin(0)).norm());
    for (std::size_t i = 0; i < mechanism.links().size(); ++i) {
      length_ =
          std::max(length_, (bodies_.centreOfMass(static_cast<int>(i)) - bodies_.origin(0)).norm());
    }
    if (length_ == 0) length_ = 1;
    addBalances();
    for (std::size_t c = 0; c < scene.closures.size(); ++c) addFreeDirections(c);
    addPassiveCoordinates(motion);
    solve();
  }

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
  Real sizeOfLoops() const {
    long double size = 0;
    for (const Closure& closure : scene_.closures) size = std::max(size, reachOf(closure));
    return static_cast<Real>(size / length_);
  }
  /// The largest share of the loads' work along a motion that nothing holds, which nothing bears:
  /// the sum of the works of all balances over the sum of their magnitudes; 0 without such a
  /// motion. It does not depend on loads elsewhere.
  Real unborne() const {
    Real most = 0;
    if (freeMotions() == 0) return most;
    Eigen::FullPivLU<Matrix> lu;
    lu.setThreshold(pivot_tolerance_);
    const Matrix motions = lu.compute(G_.transpose()).kernel();
    for (Eigen::Index i = 0; i < motions.cols(); ++i) {
      const Real work = motions.col(i).dot(b_);
      const Real largest = motions.col(i).cwiseAbs().dot(b_.cwiseAbs());
      if (largest > 0) most = std::max(most, std::abs(work) / largest);
    }
    return most;
  }

  struct Reaction {
    Vector6 wrench;  ///< force, moment; one of many solutions where it is not determined
    std::array<bool, 6> determined;
    std::array<Real, 6> freedom;  ///< by how much null vectors change it, against kFree
  };
  /// The reaction of a joint, a closure or "ground" in root axes.
  Reaction rootAxes(const std::string& name) const { return reaction(name, Matrix3l::Identity()); }
  /// The reaction in axes of the child link or of a closure's child frame.
  Reaction childAxes(const std::string& name) const {
    return reaction(name, cuts_[indexOf(name)].R.transpose());
  }

  /// The reaction in root axes, or in child axes, with its moment about another point, root axes.
  Reaction rootAxesAbout(const std::string& name, const Vector3l& point) const {
    return reaction(name, Matrix3l::Identity(), cuts_[indexOf(name)].o - point);
  }
  Reaction childAxesAbout(const std::string& name, const Vector3l& point) const {
    const Cut& cut = cuts_[indexOf(name)];
    return reaction(name, cut.R.transpose(), cut.o - point);
  }

  /// Whether a component in root axes is determined by the criterion of M. Wojtyra, "Joint reaction
  /// forces in multibody systems with redundant constraints", Multibody System Dynamics 14 (2005):
  /// it is determined when the rank drops without it.
  bool rankDropsWithout(const std::string& name, int i) const {
    const Eigen::Index column = at(indexOf(name)) + i;
    Matrix left = G_;
    left.col(column) = left.template rightCols<1>();
    left.conservativeResize(Eigen::NoChange, left.cols() - 1);
    return rankOf(left) < rankOf(G_);
  }

  struct Effort {
    Real value;
    bool determined;
    Real freedom;  ///< by how much null vectors change it, a torque over the length
  };
  /// The effort of a generalized coordinate, or of an actuated closure by its name.
  Effort effort(int coordinate) const {
    return effort(effortRow(coordinate), static_cast<Real>(terms_[coordinate]));
  }
  Effort closureEffort(const std::string& name) const {
    const std::size_t cut = indexOf(name);
    const Closure& closure = scene_.closures[cut - mechanism_.joints().size() - 1];
    Vector row = Vector::Zero(G_.cols());
    const bool slides = closure.type == ClosureType::kPrismatic;
    row.template segment<3>(at(cut) + (slides ? 0 : 3)) =
        (cuts_[cut].R.col(2) * (slides ? 1 : length_)).template cast<Real>();
    return effort(row, 0);
  }

  /// By how much reactions of every joint, "ground" and closure, in root axes, violate the
  /// equations, relative to the largest load or 1 N. It is small for any one of many solutions.
  template <typename WrenchOf>
  Real violationBy(const WrenchOf& wrench_of) const {
    Vector x(G_.cols());
    for (std::size_t cut = 0; cut < cuts_.size(); ++cut) {
      const Wrench wrench = wrench_of(cuts_[cut].name);
      x.template segment<3>(at(cut)) = wrench.force.cast<Real>();
      x.template segment<3>(at(cut) + 3) =
          (wrench.torque.cast<long double>() / length_).template cast<Real>();
    }
    return violation(x);
  }

 private:
  struct Cut {
    std::string name;
    int parent, child;  // links; parent -1: ground
    Vector3l o;         // point about which the moment is taken
    Matrix3l R;         // child axes
  };

  static Scene withoutLoops(Scene scene) {
    scene.closures.clear();
    scene.springs.clear();
    scene.actuated.reset();
    scene.assembly.clear();
    return scene;
  }

  static Eigen::Index at(std::size_t cut) { return 6 * static_cast<Eigen::Index>(cut); }

  std::size_t indexOf(const std::string& name) const {
    std::size_t cut = 0;
    while (cuts_.at(cut).name != name) ++cut;
    return cut;
  }

  // The largest distance of a closure's frames and the joints of its loop from the root's origin.
  long double reachOf(const Closure& closure) const {
    long double reach = 0;
    const auto include = [&](const Vector3l& o) {
      reach = std::max(reach, (o - bodies_.origin(0)).norm());
    };
    std::vector<bool> on_loop(mechanism_.joints().size(), false);
    for (const LinkFrame* frame : {&closure.parent, &closure.child}) {
      include(PlacedFrame(mechanism_, bodies_, *frame).o);
      int link = mechanism_.linkIndex(frame->link);
      for (; link > 0; link = mechanism_.joint(mechanism_.link(link).parent_joint).parent_link) {
        const auto joint = static_cast<std::size_t>(mechanism_.link(link).parent_joint);
        on_loop[joint] = !on_loop[joint];
      }
    }
    for (std::size_t k = 0; k < on_loop.size(); ++k) {
      if (on_loop[k]) include(cuts_[k].o);
    }
    return reach;
  }

  static Matrix3l cross(const Vector3l& r) {
    Matrix3l m;
    m << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
    return m;
  }

  // The balances of force, and of moment about the centre of mass over the length, of every link.
  void addBalances() {
    const Eigen::Index links = static_cast<Eigen::Index>(mechanism_.links().size());
    rows_ = 6 * links;
    const Eigen::Index most = rows_ + at(scene_.closures.size()) +
                              static_cast<Eigen::Index>(mechanism_.coordinates().size());
    G_.setZero(most, at(cuts_.size()));
    b_.setZero(most);
    for (std::size_t cut = 0; cut < cuts_.size(); ++cut) {
      for (const int sign : {1, -1}) {
        const int link = sign > 0 ? cuts_[cut].child : cuts_[cut].parent;
        if (link < 0) continue;
        auto block = G_.template block<6, 6>(6 * link, at(cut));
        const Vector3l r = cuts_[cut].o - bodies_.centreOfMass(link);
        block.template topLeftCorner<3, 3>() = Real(sign) * Matrix3::Identity();
        block.template bottomRightCorner<3, 3>() = Real(sign) * Matrix3::Identity();
        block.template bottomLeftCorner<3, 3>() = (sign * cross(r) / length_).template cast<Real>();
      }
    }
    for (Eigen::Index link = 0; link < links; ++link) {
      const auto demand = bodies_.demand(static_cast<int>(link));
      load(static_cast<int>(link), bodies_.centreOfMass(static_cast<int>(link)), demand.force);
      b_.template segment<3>(6 * link + 3) += (demand.torque / length_).template cast<Real>();
    }
    for (const PointSpring& spring : scene_.springs) {
      const SpringForce pull(mechanism_, bodies_, spring);
      load(mechanism_.linkIndex(spring.link_a), pull.a, -pull.force_on_a);
      load(mechanism_.linkIndex(spring.link_b), pull.b, pull.force_on_a);
    }
  }

  void load(int link, const Vector3l& point, const Vector3l& force) {
    const Vector3l moment = (point - bodies_.centreOfMass(link)).cross(force);
    b_.template segment<3>(6 * link) += force.template cast<Real>();
    b_.template segment<3>(6 * link + 3) += (moment / length_).template cast<Real>();
  }

  void addRow(const Vector& row, Real value) {
    G_.row(rows_) = row.transpose();
    b_[rows_] = value;
    ++rows_;
  }

  void addFree(std::size_t cut, bool moment, const Vector3l& direction) {
    Vector row = Vector::Zero(G_.cols());
    row.template segment<3>(at(cut) + (moment ? 3 : 0)) = direction.template cast<Real>();
    addRow(row, 0);
  }

  bool actuated(const std::string& name) const {
    if (!scene_.actuated) return mechanism_.jointIndex(name) >= 0;
    return std::count(scene_.actuated->begin(), scene_.actuated->end(), name) > 0;
  }

  void addFreeDirections(std::size_t c) {
    using Type = ClosureType;
    const Closure& closure = scene_.closures[c];
    if (actuated(closure.name)) return;  // one free direction, which carries the effort
    const std::size_t cut = mechanism_.joints().size() + 1 + c;
    const PlacedFrame parent(mechanism_, bodies_, closure.parent);
    const Matrix3l& R = cuts_[cut].R;
    const auto slide = [&](const Vector3l& direction) { addFree(cut, false, direction); };
    const auto turn = [&](const Vector3l& direction) { addFree(cut, true, direction); };
    const Type type = closure.type;
    if (type == Type::kRevolute || type == Type::kCylindrical || type == Type::kPlanar) {
      turn(R.col(2));
    }
    if (type == Type::kPrismatic || type == Type::kCylindrical) slide(R.col(2));
    if (type == Type::kPlanar) {
      slide(R.col(0));
      slide(R.col(1));
    }
    if (type == Type::kUniversal) {
      turn(parent.R.col(2));
      turn(R.col(0));
    }
    if (type == Type::kSpherical || type == Type::kDistance) {
      for (int i = 0; i < 3; ++i) turn(Vector3l::Unit(i));
    }
    if (type == Type::kDistance) {
      const Vector3l rod = (cuts_[cut].o - parent.o).normalized();
      const Vector3l across = rod.unitOrthogonal();
      slide(across);
      slide(rod.cross(across));
    }
  }

  // The row that sums what the joints of a coordinate carry along their axes, as they mimic it.
  Vector effortRow(int coordinate) const {
    Vector row = Vector::Zero(G_.cols());
    for (std::size_t k = 0; k < mechanism_.joints().size(); ++k) {
      const Joint& joint = mechanism_.joints()[k];
      if (joint.coordinate != coordinate) continue;
      const Vector3l axis = cuts_[k].R * joint.axis_K;
      const bool slides = joint.type == JointType::kPrismatic;
      row.template segment<3>(at(k) + (slides ? 0 : 3)) =
          (joint.multiplier * axis * (slides ? 1 : length_)).template cast<Real>();
    }
    return row;
  }

  // Adds the equations of passive coordinates, which have no effort other than springs, friction
  // and rotors of the scene's terms.
  void addPassiveCoordinates(const Motion& motion) {
    terms_.assign(mechanism_.coordinates().size(), 0);
    for (const JointTerms& terms : scene_.joints) {
      const Joint& joint = mechanism_.joints()[mechanism_.jointIndex(terms.joint)];
      const long double m = joint.multiplier;
      const long double q = m * motion.q[joint.coordinate] + joint.offset;
      const long double rate = scene_.static_motion ? 0 : motion.qd[joint.coordinate];
      const long double acceleration = scene_.static_motion ? 0 : motion.qdd[joint.coordinate];
      const long double s = std::clamp(m * rate / terms.coulomb_velocity, -1.0L, 1.0L);
      terms_[joint.coordinate] +=
          m * (terms.stiffness * (q - terms.rest) + terms.damping.value_or(0) * m * rate +
               terms.coulomb.value_or(0) * s * (3 - s * s) / 2 +
               terms.rotor_inertia * m * acceleration + terms.offset);
    }
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      if (actuated(mechanism_.coordinateNames()[i])) continue;
      const Vector row = effortRow(static_cast<int>(i));
      const bool turns = mechanism_.unitOf(static_cast<int>(i)) == Unit::kRadian;
      const Real unit = turns ? static_cast<Real>(length_) : Real(1);
      addRow(row / unit, static_cast<Real>(-terms_[i]) / unit);
    }
  }

  Eigen::Index rankOf(const Matrix& matrix) const {
    Eigen::FullPivLU<Matrix> lu;
    lu.setThreshold(pivot_tolerance_);
    return lu.compute(matrix).rank();
  }

  void solve() {
    G_.conservativeResize(rows_, Eigen::NoChange);
    b_.conservativeResize(rows_);
    Eigen::FullPivLU<Matrix> lu;
    lu.setThreshold(pivot_tolerance_);
    lu.compute(G_);
    x_ = lu.solve(b_);
    for (Eigen::Index i = 0; i < lu.matrixLU().diagonalSize(); ++i) {
      const Real pivot = std::abs(lu.matrixLU()(i, i)) / lu.maxPivot();
      if (pivot > pivot_tolerance_) {
        least_counted_ = std::min(least_counted_, pivot);
      } else {
        largest_left_out_ = std::max(largest_left_out_, pivot);
      }
    }
    N_.resize(G_.cols(), 0);
    if (lu.dimensionOfKernel() == 0) return;
    const Matrix kernel = lu.kernel();
    N_ = Eigen::HouseholderQR<Matrix>(kernel).householderQ() *
         Matrix::Identity(kernel.rows(), kernel.cols());
  }

  Real violation(const Vector& x) const {
    return (G_ * x - b_).cwiseAbs().maxCoeff() / std::max(Real(1), b_.cwiseAbs().maxCoeff());
  }

  Real freedom(const Vector& row) const {
    return N_.cols() == 0 ? Real(0) : (row.transpose() * N_).norm();
  }

  Effort effort(const Vector& row, Real terms) const {
    const Real free = freedom(row);
    return {row.dot(x_) + terms, free <= kFree, free / row.norm()};
  }

  // `lever` leads to the point of the unknown moment from that of the moment that is wanted.
  Reaction reaction(const std::string& name, const Matrix3l& axes,
                    const Vector3l& lever = Vector3l::Zero()) const {
    const Eigen::Index first = at(indexOf(name));
    Reaction reaction;
    for (int i = 0; i < 6; ++i) {
      const bool moment = i >= 3;
      Vector row = Vector::Zero(G_.cols());
      row.template segment<3>(first + (moment ? 3 : 0)) =
          axes.row(i % 3).transpose().template cast<Real>();
      if (moment) {
        const Vector3l axis = axes.row(i % 3).transpose();
        row.template segment<3>(first) = (axis.cross(lever) / length_).template cast<Real>();
      }
      reaction.wrench[i] = row.dot(x_) * static_cast<Real>(moment ? length_ : 1);
      reaction.freedom[static_cast<std::size_t>(i)] = freedom(row);
      reaction.determined[static_cast<std::size_t>(i)] = freedom(row) <= kFree;
    }
    return reaction;
  }

  const Mechanism& mechanism_;
  const Scene& scene_;
  NewtonEulerOracle bodies_;
  std::vector<Cut> cuts_;  // joints, ground, closures
  long double length_ = 0;
  Real pivot_tolerance_, least_counted_ = 1, largest_left_out_ = 0;
  Eigen::Index rows_ = 0;
  Matrix G_, N_;
  Vector b_, x_;
  std::vector<long double> terms_;  // effort by joint terms of each coordinate
};

using MaximalCoordinatesOracle = MaximalCoordinates<long double>;

}  // namespace virtual_work_dynamics
