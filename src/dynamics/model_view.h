#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// How a mechanism with arrows at its joints is best looked at, from its position at the start:
/// that in which its loops are assembled; of an open chain, each joint at zero or at the limit next
/// to zero. Vectors are in axes of the root link.
struct ModelView {
  /// The box around origins of links, centres of mass, and points of closures, springs and applied
  /// wrenches, m; of an open chain also where all its joints have turned somewhat.
  Eigen::AlignedBox3d box;
  double size = 1;  ///< diagonal of the box, m; 1 where it is a point

  bool from_above = false;    ///< whether it is seen along -z, without perspective
  double turn = 0;            ///< from_above: angle of the camera about z, rad
  double yaw = 0, pitch = 0;  ///< otherwise: where the camera stands, seen from the model, rad
  bool upside_down = false;   ///< otherwise: whether -z is up
  Eigen::Vector3d right, up;  ///< of the picture

  /// Lengths of arrows for a force and a moment, m/N and m/(N m). The largest force and the largest
  /// moment of the reactions that are asked for, at rest at the start, are kArrow of the size.
  /// Where nothing loads them there, those of accelerations of 1 rad/s^2 or 1 m/s^2, or of the
  /// weight.
  double force_scale = 1, torque_scale = 1;

  /// What arrows of a legend stand for, N and N m; and the width of a grid's cells, m: round
  /// numbers.
  double legend_force = 1, legend_torque = 1, cell = 1;

  /// Height of texts at the joints, m; and by reaction, how many lines its text is to be moved up,
  /// or down where negative, for the texts not to cover each other, as far as there is room.
  double text_height = 1;
  std::vector<int> text_lines;

  static constexpr double kArrow = 0.3;
};

/// @param reactions those that are asked for (requestedReactions()).
/// @throws SceneError as Dynamics does.
ModelView modelView(const Mechanism& mechanism, const Scene& scene,
                    const std::vector<std::string>& reactions);

}  // namespace virtual_work_dynamics
