#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "ros/contact_places.h"
#include "touching_bodies.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

Mechanism hipThatSlides() {
  BodiesOnAxes bodies;
  bodies.slide(0, bodies.z());
  return bodies.build();
}

// A plan that is refused once, as while another foot still stands, is tried again while the foot
// stays where it is and nothing else changes; the reason is said once.
TEST(GapRecord, WhatIsRefusedIsTriedAgain) {
  const Mechanism mechanism = hipThatSlides();
  const Scene scene = sceneOf(
      "contacts: [{name: foot, link: link_1, slip: all, closed: false, "
      "gap: {close: 0.002, open: 0.006}, plane: {link: link_0}}]");
  Counters counters;
  SceneInputs inputs(mechanism, scene, "", RootSettings(), counters);
  GapRecord gaps(mechanism, scene);
  bool refuses = true;
  int refusals = 0, tries = 0;
  std::string changes;
  for (int i = 0; i < 1000; ++i) {
    gaps.take(motionOf({0.001}, {0}, {0}));
    gaps.hand(inputs);
    if (!inputs.changed()) continue;
    ++tries;
    if (i > 500) refuses = false;
    const SceneInputs::News news = inputs.adapt(
        [&](const Scene&) {
          if (refuses) throw SceneError("attempt " + std::to_string(tries));
        },
        [](Scene&, const std::vector<std::size_t>&) {});
    if (!news.refused.empty()) ++refusals;
    changes += news.changes;
  }
  EXPECT_TRUE(inputs.scene().closures[0].touch.closed);
  EXPECT_EQ(inputs.scene().closures[0].parent.xyz.z(), 0.001);
  EXPECT_EQ(changes, "'foot' touches");
  EXPECT_EQ(refusals, 1);
  EXPECT_LE(tries, 10);
}

}  // namespace
}  // namespace virtual_work_dynamics
