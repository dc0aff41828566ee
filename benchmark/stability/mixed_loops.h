#pragma once

#include <optional>
#include <string>
#include <vector>

#include "stability/structured_loops.h"

namespace virtual_work_dynamics {

/// Random mechanisms in which all kinds of conditions meet: closures of all types, wheels of every
/// kind of slip, with rollers, tubes and as balls, blades, points that stick, slip and are lifted,
/// several of them on one plane; cylinders and cables; pairs of gears, planetary sets and racks,
/// outside and inside, straight and helical; couplings, some on rates alone, some that say what
/// others say; springs with dampers, joint terms, payloads, mimic and fixed joints, roots that
/// move, and too few actuated joints with and without free_motion. Axes, sizes and masses are those
/// of StructuredLoops. The same seed gives the same mechanisms.
class MixedLoops : private StructuredLoops {
 public:
  explicit MixedLoops(std::uint32_t seed) : StructuredLoops(seed) {}

  ClosedCase next();

 private:
  /// A link of a wheel or rack, in which the axes of the gears are turned by `axes`.
  struct Geared {
    std::string name;
    Matrix3l axes;
  };

  std::string name(const char* kind) { return kind + std::to_string(++names_); }
  Geared gearedLink(Description& tree, int parent, const Vector3l& at, const Matrix3l& R,
                    JointType type);
  LinkFrame frameOf(const Geared& geared, double height);
  void mesh(ClosureType type, const Geared& parent, const Geared& child, double parent_radius,
            double child_radius);
  void addPair(Description& tree, int base, const Vector3l& at, const Matrix3l& R);
  void addRack(Description& tree, int base, const Vector3l& at, const Matrix3l& R);
  void addPlanets(Description& tree, int base, const Vector3l& at, const Matrix3l& R);
  void addGears(Description& tree);
  Mechanism mixedMechanism();

  void addTouches(const Mechanism& mechanism, const NewtonEulerOracle& bodies, Scene& scene);
  Touch touch(ClosureType type);
  Eigen::Vector3d childAxes(ClosureType type, const Matrix3l& R_0L, const Matrix3l& R_plane);
  void addCylinder(const Mechanism& mechanism, const NewtonEulerOracle& bodies, Scene& scene);
  void addCouplings(const Mechanism& mechanism, Scene& scene);
  void addTerms(const Mechanism& mechanism, Scene& scene);
  void addBodies(const Mechanism& mechanism, Scene& scene);
  void moveRoot(Scene& scene, Motion& motion);
  void chooseForces(const Mechanism& mechanism, Scene& scene);
  void addConditions(const Mechanism& mechanism, const NewtonEulerOracle& bodies, Scene& scene);

  int names_ = 0;
  std::vector<Closure> teeth_;
};

}  // namespace virtual_work_dynamics
