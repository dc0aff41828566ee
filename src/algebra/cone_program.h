#pragma once

#include <Eigen/Core>
#include <cmath>
#include <utility>
#include <vector>

namespace virtual_work_dynamics {

/// Least and greatest values of linear functions of free variables y, of which some must not be
/// negative and others must stay inside the friction cone of one: a linear program by the simplex
/// method, which goes from corner to corner. A cone is a pyramid of kSides sides around it, so that
/// bounds are never too narrow; its sides are not stored but found where they are met. Meant for
/// tens of variables. Nothing after construction allocates.
class ConeProgram {
 public:
  /// The pyramid is wider than the cone by 1 / cos(pi / kSides) - 1 < 1e-4 at most.
  static constexpr int kSides = 256;
  /// Functions of which |(along)| <= friction * normal, and normal >= 0.
  struct Cone {
    Eigen::Index normal = 0, along = 0;  ///< indices of functions; those along are neighbours
    int count = 0;                       ///< of functions along; with none, only normal >= 0
    double friction = 0;
  };
  enum class Found { kFeasible, kInfeasible, kUnclear };

  ConeProgram(Eigen::Index most_variables, Eigen::Index most_functions, std::size_t most_cones);

  /// Starts anew with functions that are zero.
  void start(Eigen::Index variables, Eigen::Index functions);
  /// The value of a function at y = 0, then its coefficients, of about one.
  auto function(Eigen::Index i) { return table_.row(i).head(variables_ + 1); }
  void addCone(const Cone& cone) { cones_.push_back(cone); }

  /// Looks for any solution. @param scale the largest of values: what is small of it is zero
  Found solve(double scale);
  /// Least and greatest value of a function; infinite where there is none, and NaN where that was
  /// not found out. After kFeasible.
  std::pair<double, double> range(Eigen::Index function);
  /// Whether sign times a function decreases without bound; "no" as well where rounding errors hide
  /// it. After kFeasible.
  bool recedes(Eigen::Index function, double sign);

 private:
  // Values below this fraction of the scale are zero.
  static constexpr double kZero = 1e-10;
  // Coefficients and multipliers below this are rounding errors.
  static constexpr double kNoCoefficient = 1e-9;
  // Values of this many scales are none that forces have.
  static constexpr double kMostScales = 1000;
  static constexpr double kSideAngle = 2 * M_PI / kSides;
  using RowOfPlane = Eigen::Ref<Eigen::VectorXd, 0, Eigen::InnerStride<>>;
  enum class Step { kDone, kUnbounded, kStuck, kInfeasible };
  /// A plane that bounds y: a side of a cone, or its normal.
  struct Plane {
    std::size_t cone = 0;
    int side = -1;  // -1: the normal
    bool operator<(const Plane& other) const {
      return cone != other.cone ? cone < other.cone : side < other.side;
    }
  };
  /// A plane, the value of what must not be negative there, and its rate along a direction.
  struct Met {
    Plane plane;
    double value = 0, rate = 0;
    bool found = false;
  };
  double tolerance() const;
  void setPlane(const Plane& plane, RowOfPlane row) const;
  double combined(const Plane& plane, double normal, double x, double y) const;
  Plane sideTowards(std::size_t cone, double x, double y) const;
  double valueOf(Eigen::Index function) const;
  void addStartPlane(const Plane& plane);
  void span();
  void reduce();
  bool refresh();
  bool exchange(Eigen::Index place, const Plane& plane);
  void placeCorner();
  void keepCorner();
  Met mostViolated() const;
  Met blocking(bool by_number);
  Met meetCone(std::size_t cone) const;
  Step restore();
  Step improve();
  double least(Eigen::Index function, double sign);

  Eigen::Index most_variables_;
  Eigen::Index variables_ = 0, functions_ = 0;
  Eigen::Index rank_ = 0;  // number of variables that planes bound
  double scale_ = 0;
  int exchanges_ = 0;  // since the inverse was made
  int side_step_ = 1;  // of the sides of pyramids that count
  std::vector<Cone> cones_;
  std::vector<double> cosines_, sines_;  // by side
  std::vector<Plane> corner_;            // planes that meet there
  std::vector<Plane> start_;    // planes to choose the first corner of; then solve()'s last corner
  std::vector<Met> met_;        // by cone
  Eigen::MatrixXd start_rows_;  // by start plane
  using Table = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Table table_;                    // by function: value at y = 0, coefficients
  Table reduced_;                  // the same with those combinations of variables that count
  Eigen::VectorXd unbounded_;      // by function: size of its part in the others
  Eigen::MatrixXd basis_;          // columns: these combinations
  Eigen::MatrixXd inverse_, own_;  // of the corner's planes; columns are edges
  Eigen::VectorXd y_, edge_, factors_, multipliers_, objective_, rates_;
};

}  // namespace virtual_work_dynamics
