#pragma once

#include <array>

namespace virtual_work_dynamics {

/// Search for the least value of a function of up to four numbers by the simplex of Nelder and Mead
/// (1965), which asks for one value after the other, so that whoever computes them can take breaks.
/// Does not allocate.
class SimplexSearch {
 public:
  static constexpr int kMaxDimensions = 4;
  using Point = std::array<double, kMaxDimensions>;

  /// Starts from a point and one step along each of the `dimensions` axes. The search ends once no
  /// corner is farther than `tolerance` from the best one along any axis, or after `most` values.
  void start(const Point& first, const Point& steps, int dimensions, double tolerance, int most);

  /// The point whose value is wanted; not to be called when finished().
  const Point& asked() const { return asked_; }
  /// Gives the value of the point that is asked for.
  void tell(double value);

  bool finished() const { return stage_ == Stage::kFinished; }
  const Point& best() const { return corners_[0]; }
  double bestValue() const { return values_[0]; }

 private:
  enum class Stage { kCorners, kReflect, kExpand, kContract, kShrink, kFinished };

  void beginRound();
  void ask(double factor, Stage stage);
  void replaceWorst(const Point& point, double value);
  void askCorner(int corner, Stage stage);
  double size() const;

  int dimensions_ = 0;
  double tolerance_ = 0;
  int left_ = 0;  // values that may still be asked for
  Stage stage_ = Stage::kFinished;
  int corner_ = 0;
  std::array<Point, kMaxDimensions + 1> corners_{};  // in a round: from best to worst
  std::array<double, kMaxDimensions + 1> values_{};
  Point centre_{};  // of all corners except the worst
  Point asked_{};
  Point reflected_{};
  double reflected_value_ = 0;
};

}  // namespace virtual_work_dynamics
