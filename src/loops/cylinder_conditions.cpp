#include "loops/cylinder_conditions.h"

#include <Eigen/Geometry>
#include <utility>

namespace virtual_work_dynamics {

CylinderConditions::CylinderConditions(const Mechanism& mechanism, const Closure& closure,
                                       const Frame& parent, const Frame& child,
                                       std::vector<PathStep> path, std::vector<int> coordinates)
    : ClosureConditions(mechanism, closure, {}, parent, child, std::move(path),
                        std::move(coordinates)) {}

FramePair CylinderConditions::framesAt(const LinkKinematics& links) const {
  FramePair frames = ClosureConditions::framesAt(links);
  const Eigen::Vector3d r = frames.Co - frames.Po;
  const double length = r.norm();
  if (!(length > 0)) {  // no direction, so that the cylinder exerts nothing
    frames.R_P.setZero();
    return frames;
  }
  const Eigen::Vector3d z = r / length, x = z.unitOrthogonal();
  frames.R_P << x, z.cross(x), z;
  return frames;
}

void CylinderConditions::setPosition(const LoopState& state, ConditionRows rows) const {
  rows.frames() = framesAt(state.links);
}

void CylinderConditions::setMotion(const LoopState&, ConditionRows) const {}

// The length l of r grows by (|rd|^2 - ld^2) / l even where its ends do not accelerate.
double CylinderConditions::freeAcceleration(const LinkKinematics& links,
                                            const FramePair& frames) const {
  const LinkKinematics::PointMotion P = links.motionAt(parent().link, frames.Po);
  const LinkKinematics::PointMotion C = links.motionAt(child().link, frames.Co);
  const Eigen::Vector3d along = frames.R_P.col(2), v = C.v - P.v;
  const double length = (frames.Co - frames.Po).norm(), rate = along.dot(v);
  const double across = length > 0 ? (v.squaredNorm() - rate * rate) / length : 0;
  return along.dot(C.a - P.a) + across;
}

const char* CylinderConditions::fault(const LinkKinematics& links, double least) const {
  const bool coincide = (links.originOf(child()) - links.originOf(parent())).norm() <= least;
  return coincide ? "its ends coincide in the assembly" : nullptr;
}

LinkKinematics::Displacement CylinderConditions::displacedBy(const LinkKinematics& links,
                                                             const FramePair& frames,
                                                             const PathStep& step,
                                                             double length) const {
  LinkKinematics::Displacement moves = links.displacementBy(step, frames.Co, length);
  const Eigen::Vector3d r = frames.Co - frames.Po;
  const double square = r.squaredNorm();
  if (square > 0) moves.turn = r.cross(moves.origin) / square;
  return moves;
}

}  // namespace virtual_work_dynamics
