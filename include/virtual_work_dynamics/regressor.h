#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion_table.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Numbers in which efforts are linear. Those of a link are about its origin and in its axes; those
/// of a joint are what JointTerms calls so.
enum class ParameterKind {
  kMass,          ///< kg
  kFirstMomentX,  ///< mass times a coordinate of the centre of mass, kg m
  kFirstMomentY,
  kFirstMomentZ,
  kInertiaXX,  ///< moments of inertia about the origin of the link, kg m^2
  kInertiaXY,
  kInertiaXZ,
  kInertiaYY,
  kInertiaYZ,
  kInertiaZZ,
  kDamping,       ///< N m s/rad or N s/m
  kCoulomb,       ///< N m or N; the scene's `coulomb_velocity` is not among the parameters
  kRotorInertia,  ///< kg m^2 or kg
  kOffset         ///< N m or N
};

/// A word for each kind, such as "first_moment_x".
const char* nameOf(ParameterKind kind);

/// One of the numbers that a description or a scene gives and that a recording may give better.
struct Parameter {
  ParameterKind kind = ParameterKind::kMass;
  std::string of;    ///< name of the link or joint
  double value = 0;  ///< as described
};

/// The ten inertial parameters of a link, with what fixed joints hold to it, in the order of
/// ParameterKind.
/// @param mechanism without payloads, which count as known
/// @throws SceneError when there is no such link, or no effort depends on it.
std::vector<Parameter> inertialParameters(const Mechanism& mechanism, const std::string& link);

/// Names of the links that hang on joints that move, in the mechanism's order. What fixed joints
/// hold to such a link is part of its parameters.
std::vector<std::string> bodies(const Mechanism& mechanism);

/// The four parameters of each joint that moves, in the mechanism's order.
/// @throws SceneError as resolving the scene's joint terms does.
std::vector<Parameter> jointParameters(const Mechanism& mechanism, const Scene& scene);

/// What efforts are per unit of one parameter: a column of the regressor. It is computed by the
/// dynamics of a mechanism and scene in which that parameter is alone, so that it holds for
/// whatever they hold: mimic joints, closed loops, a root that moves.
class RegressorColumn {
 public:
  /// @param scene of which gravity, the root's motion, closures and what is actuated count; applied
  ///   wrenches, payloads and springs do not
  /// @param capacity the most rows of a block
  /// @throws SceneError as Dynamics, or when there is no such link or joint.
  RegressorColumn(const Mechanism& mechanism, const Scene& scene, const Parameter& parameter,
                  std::size_t capacity, int threads = 1);
  ~RegressorColumn();
  RegressorColumn(RegressorColumn&&) noexcept;
  RegressorColumn& operator=(RegressorColumn&&) noexcept;

  /// Number of efforts, in the order of Dynamics::effortNames().
  Eigen::Index efforts() const;

  /// Computes rows [first, first + count) of a table that has velocities and accelerations of all
  /// generalized coordinates, in their order.
  /// @param to receives `count` rows of efforts(), N m or N per unit of the parameter; what has no
  ///   value, in singular positions, is not a number
  /// @throws MotionError as SampleRows::compute().
  void compute(const MotionTable& table, std::size_t first, std::size_t count, double* to);

 private:
  struct Part;
  std::vector<std::unique_ptr<Part>> parts_;  // whose weighted sum the column is
};

}  // namespace virtual_work_dynamics
