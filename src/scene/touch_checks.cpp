#include "scene/touch_checks.h"

#include <cmath>

#include "base/number_text.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

void requireAtLeastZero(const std::string& what, double value) {
  if (value >= 0 && std::isfinite(value)) return;
  throw SceneError(what + " = " + numberText(value) + " is not zero or more");
}

}  // namespace

void requireSoundTouch(const Closure& closure, const std::string& place) {
  const Touch& touch = closure.touch;
  requireAtLeastZero(place + ": radius", touch.radius);
  requireAtLeastZero(place + ": tube_radius", touch.tube_radius);
  const bool wheel = closure.type == ClosureType::kRolling;
  if (wheel && touch.radius == 0 && touch.tube_radius == 0) {
    throw SceneError(place + ": radius and tube_radius are both zero");
  }
  if (touch.friction) requireAtLeastZero(place + ": friction", *touch.friction);
  if (touch.friction && !touch.normal) {
    throw SceneError(place + ": friction has no effect where normal is false");
  }
  if (touch.friction && touch.slip == Slip::kAll) {
    throw SceneError(place + ": friction has no effect on what slips in all directions");
  }
  if (closure.type == ClosureType::kContact && touch.slip != Slip::kNone &&
      touch.slip != Slip::kAll) {
    throw SceneError(place + ": a point slips in all directions or in none");
  }
  if (touch.gap && closure.type != ClosureType::kContact) {
    throw SceneError(place + ": only a contact opens and closes by its gap");
  }
  if (touch.gap && !(std::isfinite(touch.gap->close) && std::isfinite(touch.gap->open) &&
                     touch.gap->close < touch.gap->open)) {
    throw SceneError(place + ": gap: close = " + numberText(touch.gap->close) +
                     " is not less than open = " + numberText(touch.gap->open));
  }
  if (touch.roller_angle && !std::isfinite(*touch.roller_angle)) {
    throw SceneError(place + ": roller_angle is not finite");
  }
  if (touch.roller_angle && !wheel) throw SceneError(place + ": only a wheel has rollers");
  if (closure.type == ClosureType::kKnifeEdge && touch.slip != Slip::kNone) {
    throw SceneError(place + ": a blade slips along its direction and not across it");
  }
  if (touch.slip == Slip::kAll && !touch.normal && !touch.roller_angle) {
    throw SceneError(place + ": holds nothing: it slips and its normal is false");
  }
}

}  // namespace virtual_work_dynamics
