#pragma once

#include <string>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// Finds numbers of a description that are hardly in SI units, one doubt for each link or joint:
/// radii of gyration and centres of mass beyond ten times the size of the robot (g mm^2, mm),
/// origins of joints beyond all robots of its mass (mm), masses beyond that of a steel block of its
/// size and travel (g), and limits of revolute joints in degrees.
std::vector<Doubt> unitDoubts(const std::vector<Link>& links, const std::vector<Joint>& joints);

/// The largest position, rad or m, that a joint with these limits may have without a question;
/// infinite without limits.
double largestPosition(const Joint& joint);

/// What to ask about a position beyond that.
std::string positionQuestion(const Joint& joint, double position);

}  // namespace virtual_work_dynamics
