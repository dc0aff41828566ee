#pragma once

#include <cstddef>
#include <vector>

#include "scene/joint_terms.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/request.h"
#include "virtual_work_dynamics/scene.h"
#include "witness/lagrange/variation_frames.h"

namespace virtual_work_dynamics {

/// What Lagrange's equations need to know of a mechanism, a scene and a request, rounded once to
/// Real. Link i + 1 hangs on joint i, link 0 is the root.
template <typename Real>
struct LagrangePlan {
  /// @throws SceneError as InverseDynamics does.
  LagrangePlan(const Mechanism& mechanism, const Scene& scene, const Request& request);

  struct JointData {
    JointType type = JointType::kFixed;
    int parent = 0;       ///< link
    int coordinate = -1;  ///< position = multiplier * q[coordinate] + offset
    Real multiplier = 1;
    Real offset = 0;
    Triple<Real> p_PoKo_P{};  ///< at position zero
    Matrix<Real> R_PK{};      ///< at position zero
    Triple<Real> axis_K{};
    Triple<Real> axis_P{};
    int orientation = -1;  ///< of a motion, behind `frame`; R_PK is then that of the sample
    Matrix<Real> frame{};
    /// Rodrigues: R_PK(q) = along + sin(q) sine + cos(q) cosine.
    Matrix<Real> along{}, sine{}, cosine{};
  };

  struct Applied {
    bool in_root_axes = false;
    Triple<Real> at{};  ///< link frame
    Triple<Real> force{}, torque{};
  };

  struct LinkData {
    Real mass = 0;
    Triple<Real> p_KoCm_K{};
    bool has_inertia = false;
    Matrix<Real> inertia_Cm_K{};
    std::vector<Applied> applied;
  };

  /// A link whose pose depends on the direction of differentiation.
  struct Step {
    int link = 0;
    bool parent_depends = false;
    bool joint_depends = false;  ///< its own joint moves with the coordinate
  };

  struct Coordinate {
    std::vector<Step> steps;                ///< parents first
    std::vector<ResolvedJointTerms> terms;  ///< terms of the joints that it moves
  };

  struct Reaction {
    int link = 0;            ///< child link; 0: ground
    std::vector<int> links;  ///< links behind `link` that the joint carries and that matter
    bool drop_active = false;
    /// Of a joint of several freedoms: its parts, indices into `joints`; of a joint of one: none.
    std::vector<int> parts;
    bool screw = false;
    bool ball = false;     ///< whether it turns freely
    bool moved = false;    ///< the moment is about `point` instead of O_k
    int point_link = 0;    ///< the link that the point is fixed on
    Triple<Real> point{};  ///< in the frame of that link
  };

  /// Where an applied wrench of the scene stands.
  struct AppliedPlace {
    int link = 0;
    std::size_t index = 0;  ///< into LinkData::applied
  };

  std::vector<JointData> joints;
  std::vector<LinkData> links;
  std::vector<AppliedPlace> applied;  ///< in the scene's order
  Triple<Real> gravity{};             ///< inertial axes
  bool static_motion = false;
  bool root_moves = false;
  int coordinate_count = 0;
  std::vector<Coordinate> coordinates;  ///< empty when efforts are not wanted
  std::vector<Reaction> reactions;      ///< those wanted in either axes, each once
  std::vector<int> child_axes;          ///< indices into reactions
  std::vector<int> root_axes;
};

extern template struct LagrangePlan<double>;
extern template struct LagrangePlan<long double>;

}  // namespace virtual_work_dynamics
