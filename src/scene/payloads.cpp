#include "scene/payloads.h"

#include <string>
#include <vector>

#include "base/number_text.h"
#include "robot/inertia_doubts.h"
#include "scene/lookup.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

// Inertia of a mass about a point at a distance.
Matrix3l steiner(long double mass, const Vector3l& from) {
  return mass * (from.squaredNorm() * Matrix3l::Identity() - from * from.transpose());
}

void add(const Payload& payload, Link& link) {
  const long double own = link.mass, more = payload.mass;
  const Vector3l at = payload.at.cast<long double>();
  const Vector3l centre = (own * link.p_KoCm_K + more * at) / (own + more);
  link.inertia_Cm_K += steiner(own, link.p_KoCm_K - centre) + payload.inertia.cast<long double>() +
                       steiner(more, at - centre);
  link.p_KoCm_K = centre;
  link.mass = own + more;
}

}  // namespace

std::string payloadProblem(const Payload& payload) {
  if (!(payload.mass > 0)) {
    return "mass: " + numberText(payload.mass) + " kg is not a positive mass";
  }
  const std::string why = impossibleInertia(payload.inertia.cast<long double>());
  return why.empty() ? "" : "inertia: " + why;
}

LoadedMechanism::LoadedMechanism(const Mechanism& mechanism, const Scene& scene)
    : bare_(mechanism) {
  if (scene.payloads.empty()) return;
  std::vector<Link> links = mechanism.links();
  for (std::size_t i = 0; i < scene.payloads.size(); ++i) {
    const std::string place = entryOf("payload", i);
    const Payload& payload = scene.payloads[i];
    const std::string problem = payloadProblem(payload);
    if (!problem.empty()) throw SceneError(place + "." + problem);
    add(payload,
        links[static_cast<std::size_t>(linkNamed(mechanism, payload.link, place + ".link"))]);
  }
  loaded_.emplace(mechanism.name(), std::move(links), mechanism.joints(), mechanism.doubts(),
                  mechanism.compounds());
}

}  // namespace virtual_work_dynamics
