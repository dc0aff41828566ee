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
/// does not move it. Serves one thread; nothing after construction allocates.
class ContactGaps {
 public:
  /// A contact that has a gap.
  struct Contact {
    std::size_t closure;  ///< index among the scene's
    bool closed;          ///< at first as the scene says
    double distance = 0;  ///< of its point above its plane, m, of the motion that was taken last
  };

  /// @throws SceneError naming a link that does not exist.
  ContactGaps(const Mechanism& mechanism, const Scene& scene);

  const std::vector<Contact>& contacts() const { return contacts_; }
  /// Takes a motion of all coordinates. Returns whether a contact closes or opens.
  bool take(const Motion& motion);

 private:
  struct Frames {
    LinkKinematics::Frame plane, point;
    Gap gap;
  };

  LinkKinematics links_;
  std::vector<Contact> contacts_;
  std::vector<Frames> frames_;  // by contact
};

}  // namespace virtual_work_dynamics
