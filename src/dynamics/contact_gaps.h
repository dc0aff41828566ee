#pragma once

#include <cstddef>
#include <vector>

#include "loops/link_kinematics.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Which contacts are closed, by where motions have their points above their planes: each closes
/// at Touch::gap's `close` and opens above its `open`, so that noise of less than what lies between
/// does not move it. Where it comes to stand is where the surface is, whatever calibration makes of
/// the height: from its closing on it follows the point, until that stands. Serves one thread;
/// nothing after construction allocates.
class ContactGaps {
 public:
  /// A contact that has a gap.
  struct Contact {
    std::size_t closure;  ///< index among the scene's
    bool closed;          ///< at first as the scene says
    double distance = 0;  ///< of its point above its plane, m, of the motion that was taken last
    double height = 0;    ///< of the surface above its plane, m, while it is closed
  };

  /// @throws SceneError naming a link that does not exist.
  ContactGaps(const Mechanism& mechanism, const Scene& scene);

  const std::vector<Contact>& contacts() const { return contacts_; }
  /// Takes a motion of all coordinates. Returns whether a contact closes, opens, or has another
  /// height.
  bool take(const Motion& motion);
  /// A point of the surface at a height, in the link that the plane belongs to. Any thread may ask.
  Eigen::Vector3d surface(std::size_t contact, double height) const {
    const LinkKinematics::Frame& plane = frames_[contact].plane;
    return plane.p_LoFo_L + height * plane.R_LF.col(2);
  }

 private:
  // How a closed contact comes to stand.
  struct Landing {
    double about = 0;        // the distance that it has stayed near to
    int stays = 0, all = 0;  // samples for which it has, and since it closed
  };
  bool land(std::size_t i);
  struct Frames {
    LinkKinematics::Frame plane, point;
    Gap gap;
  };

  LinkKinematics links_;
  std::vector<Contact> contacts_;
  std::vector<Frames> frames_;  // by contact
  std::vector<Landing> landings_;
};

}  // namespace virtual_work_dynamics
