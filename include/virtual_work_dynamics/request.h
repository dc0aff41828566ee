#pragma once

#include <string>
#include <vector>

namespace virtual_work_dynamics {

/// The results that a consumer wants computed; others cost nothing. Names are those of joints and
/// closures, or "ground"; results are in the order of these lists.
struct Request {
  bool efforts = true;
  std::vector<std::string> child_axes;  ///< reactions in the child link's axes
  std::vector<std::string> root_axes;   ///< reactions in root axes, (4.3)
  bool poses = false;                   ///< poses of the `root_axes` joints
  bool twists = false;                  ///< twists of the `root_axes` joints
  /// With closed loops: which results rigid-body mechanics determines,
  /// LoopResults::effort_determined and what follows it. Which results have a value at all is
  /// always found.
  bool determinacy = true;
  /// With closed loops: how far the motion violates each closure and coupling,
  /// LoopResults::residuals and relative_residuals. ClosedLoopDynamics::residualsOf() finds them
  /// now and then where they are left out.
  bool residuals = true;
  /// With closed loops, where contacts press or cables pull: whether forces that rigid-body
  /// mechanics does not determine can be chosen so that all of them hold, Hold::kCanHold.
  bool can_hold = false;
  /// Besides, the interval that each result can be in, LoopResults::least.
  bool intervals = false;
  /// Moments in child axes stay about the child frame's origin, whatever Scene::moments_about says:
  /// for consumers that take the wrench's axes and point from one frame.
  bool child_axes_about_origin = false;
};

}  // namespace virtual_work_dynamics
