#pragma once

#include <optional>
#include <string>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Why no body can be a payload of this mass and inertia, which the message begins by naming; empty
/// when one can.
std::string payloadProblem(const Payload& payload);

/// A mechanism with the payloads of a scene: the mechanism itself, which must outlive it, or a copy
/// whose links have the masses and inertias of theirs added.
class LoadedMechanism {
 public:
  /// @throws SceneError naming a payload of a link that is not there, or one that no body can be.
  LoadedMechanism(const Mechanism& mechanism, const Scene& scene);
  LoadedMechanism(const LoadedMechanism&) = delete;

  const Mechanism& get() const { return loaded_ ? *loaded_ : bare_; }

 private:
  const Mechanism& bare_;
  std::optional<Mechanism> loaded_;
};

}  // namespace virtual_work_dynamics
