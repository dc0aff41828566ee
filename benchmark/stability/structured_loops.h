#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "description.h"
#include "newton_euler_oracle.h"
#include "stability/random_numbers.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// A mechanism whose loops are closed at the positions of a motion, which are the scene's assembly.
/// Velocities and accelerations do not satisfy the loops, as forces do not need that.
struct ClosedCase {
  Mechanism mechanism;
  Scene scene;
  Motion motion;
  std::string kind;  ///< how its axes lie, in words
};

/// Random mechanisms with closed loops in which much is special: axes that are parallel, meet in a
/// point, lie in one line or along the root's axes; closures of all types whose frames lie on axes
/// of joints; copies of closures, also with parent and child exchanged; several loops that share
/// joints; mimic joints; joints that slide; sizes from 1e-6 to 1e6 m and masses from 1e-12 to 1e12
/// kg. Actuated joints may be too few. The same seed gives the same mechanisms.
class StructuredLoops {
 public:
  explicit StructuredLoops(std::uint32_t seed) : random_(seed) {}

  ClosedCase next();

 protected:
  enum class Axes { kAny, kParallel, kThroughOnePoint, kInOneLine, kAlongRoot };

  struct Placed {
    Matrix3l R;
    Vector3l o;
  };

  static Matrix3l turn(int axis, long double angle);
  static Matrix3l rotationOf(const Eigen::Vector3d& rpy);
  static Eigen::Vector3d rpyOf(const Matrix3l& R);
  /// Two links between which something moves, at random; none when there are none.
  std::optional<std::pair<int, int>> linksThatMove(const Mechanism& mechanism);

  int pick(int count);
  Vector3l vector(double size);
  Matrix3l rotation();
  Matrix3l rightAngles();
  Vector3l direction();
  Vector3l alongAxis();

  void chooseStyle();
  std::string wayOfAxes() const;  ///< how axes lie, in words
  Link link(int index);
  Joint joint(int index);
  Mechanism mechanism();
  void addMimics(Description& tree);
  Motion motion(const Mechanism& mechanism);
  std::optional<Closure> closure(const Mechanism& mechanism, const NewtonEulerOracle& bodies,
                                 int index);
  Placed placeOf(const Mechanism& mechanism, const NewtonEulerOracle& bodies);
  void freeMotion(ClosureType type, Vector3l& p, Matrix3l& R);
  void addCopies(Scene& scene);
  void addLoads(const Mechanism& mechanism, Scene& scene);
  void chooseActuated(const Mechanism& mechanism, Scene& scene);
  void chooseRedundancy(const Mechanism& mechanism, Scene& scene);

  RandomNumbers random_;
  Axes axes_ = Axes::kAny;
  double size_ = 1, mass_ = 1;
  double spread_of_masses_ = 0, spread_of_sizes_ = 0;  // powers of ten, either way
  bool special_positions_ = false;                     // right angles and zeros
  double beside_ = 0;                                  // how far from these, rad or of the size
};

}  // namespace virtual_work_dynamics
