#pragma once

#include <cstddef>
#include <map>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// A point that is fixed on a link.
struct LinkPoint {
  int link = 0;
  Vector3l p_LoPo_L = Vector3l::Zero();  ///< from the link's origin, link axes, m
};

/// The points of Scene::moments_about with their names resolved.
class MomentPoints {
 public:
  /// @throws SceneError naming the entry whose joint, closure or link does not exist, that is given
  ///   twice, or whose point is not finite.
  MomentPoints(const Mechanism& mechanism, const Scene& scene);

  /// The point of a joint or closure; null where its moment is about the child frame's origin.
  const LinkPoint* ofJoint(int joint) const { return find(joints_, joint); }
  const LinkPoint* ofClosure(std::size_t closure) const { return find(closures_, closure); }

 private:
  template <typename Key>
  static const LinkPoint* find(const std::map<Key, LinkPoint>& points, const Key& key) {
    const auto found = points.find(key);
    return found == points.end() ? nullptr : &found->second;
  }

  std::map<int, LinkPoint> joints_;
  std::map<std::size_t, LinkPoint> closures_;
};

}  // namespace virtual_work_dynamics
