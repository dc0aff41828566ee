#pragma once

#include <string>
#include <vector>

#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// A piece of a polynomial at an instant.
struct PolynomialInstant {
  double values[3];  ///< position, velocity and acceleration
  double sizes[3];   ///< sums of the magnitudes of their terms
};
PolynomialInstant polynomialAt(const std::vector<double>& coefficients, double t);

/// Checks that the pieces of a polynomial fit each other. `place` is how messages begin.
/// @throws SceneError naming the time of a jump, and what jumps by how much.
void requireFittingPieces(const DriveLaw& law, const std::string& place);

/// Checks that the rows of a table are those of a function that does not jump, as far as they tell:
/// a step of positions, velocities or accelerations that is unlike all steps around it, as no
/// motion makes it, is a jump. Rates that a table does not give are those of its differences.
/// @throws SceneError naming the time of a jump, and what jumps.
void requireSteadyRows(const DriveLaw& law, const std::string& place);

}  // namespace virtual_work_dynamics
