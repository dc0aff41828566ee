#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "loops/groups.h"
#include "loops/point_springs.h"
#include "scene/resolved_loops.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/request.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Results that the force of a spring reaches: of joints between its links, and of loops that these
/// take part in.
struct SpringReach {
  SpringReach(const Mechanism& mechanism, const Scene& scene, const LoopScene& loops,
              const std::vector<LoopGroup>& groups, const PointSprings& springs, std::size_t spring,
              const Request& request, const std::vector<std::string>& one_sided);

  std::vector<std::size_t> efforts;                // as in Results
  std::vector<std::size_t> child_axes, root_axes;  // as in Request
  std::vector<std::size_t> holds;                  // as in LoopHolds, of what is not lifted
};

}  // namespace virtual_work_dynamics
