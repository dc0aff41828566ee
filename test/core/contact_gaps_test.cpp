#include "dynamics/contact_gaps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "touching_bodies.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kExactGap = 1e-15;

// A foot at the end of a leg of half a metre that turns about y, below a hip that slides up; the
// floor is at -0.1 m and leans by 0.2 rad.
Mechanism hipAndLeg() {
  BodiesOnAxes bodies;
  bodies.turn(bodies.slide(0, bodies.z()), bodies.y());
  return bodies.build();
}

struct Leg {
  Mechanism mechanism = hipAndLeg();
  Scene scene = sceneOf(R"(
contacts:
  - {name: open, link: link_2, plane: {link: link_0}, closed: false}
  - {name: foot, link: link_2, at: [0, 0, -0.5], slip: all, closed: false,
     gap: {close: 0.002, open: 0.006},
     plane: {link: link_0, point: [0, 0, -0.1], normal: [-0.19866933079506122, 0, 0.9800665778412416]}}
)");
};

TEST(ContactGaps, AreDistancesAlongTheNormal) {
  const Leg leg;
  ContactGaps gaps(leg.mechanism, leg.scene);
  ASSERT_EQ(gaps.contacts().size(), 1u);
  EXPECT_EQ(gaps.contacts()[0].closure, 1u);
  EXPECT_FALSE(gaps.contacts()[0].closed);
  gaps.take(motionOf({0.7, 0.3}, {0, 0}, {0, 0}));
  const double x = -0.5 * std::sin(0.3), z = 0.7 - 0.5 * std::cos(0.3) + 0.1;
  EXPECT_NEAR(gaps.contacts()[0].distance, -std::sin(0.2) * x + std::cos(0.2) * z, kExactGap);
}

// Down and up again by small steps, with noise of half of what lies between: one change each, at
// the distances that the scene says.
TEST(ContactGaps, NoiseDoesNotMakeThemChatter) {
  const Leg leg;
  ContactGaps gaps(leg.mechanism, leg.scene);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-0.001, 0.001);
  int changes = 0;
  bool closed = false;
  for (int i = -4000; i <= 4000; ++i) {
    const double distance = 0.02 * std::abs(i) / 4000 - 0.002;
    const double up = (distance + noise(random)) / std::cos(0.2) + 0.4;
    gaps.take(motionOf({up, 0}, {0, 0}, {0, 0}));
    const ContactGaps::Contact& foot = gaps.contacts()[0];
    if (foot.closed == closed) continue;
    closed = foot.closed;
    ++changes;
    EXPECT_EQ(foot.closed, i < 0);
    EXPECT_NEAR(distance, i < 0 ? 0.002 : 0.006, 0.001) << i;
    EXPECT_TRUE(i < 0 ? foot.distance <= 0.002 : foot.distance > 0.006) << foot.distance;
  }
  EXPECT_EQ(changes, 2);
}

// It comes down, overshoots, as estimates do, and stands off the plane: there the surface is, and
// what moves it later does not take the surface along.
TEST(ContactGaps, TheSurfaceIsWhereThePointComesToStand) {
  const Leg leg;
  ContactGaps gaps(leg.mechanism, leg.scene);
  const ContactGaps::Contact& foot = gaps.contacts()[0];
  const auto take = [&](double distance) {
    return gaps.take(motionOf({distance / std::cos(0.2) + 0.4, 0}, {0, 0}, {0, 0}));
  };
  for (const double stand : {0.0015, -0.003}) {
    for (double distance = 0.01; distance > stand; distance -= 0.0005) {
      const bool changes = take(distance);
      EXPECT_EQ(changes, foot.closed) << distance;
    }
    take(stand - 0.0001);
    for (int i = 0; i < 20; ++i) take(stand);
    EXPECT_TRUE(foot.closed);
    EXPECT_NEAR(foot.height, stand, 1e-9);
    const Eigen::Vector3d surface = gaps.surface(0, foot.height);
    EXPECT_NEAR((surface - leg.scene.closures[1].parent.xyz).norm(), std::abs(stand), 1e-9);
    EXPECT_FALSE(take(stand + 0.001));
    EXPECT_NEAR(foot.height, stand, 1e-9);
    EXPECT_TRUE(take(0.01));
    EXPECT_FALSE(foot.closed);
  }
}

// Noise of as much as what lies between does not have it followed for ever.
TEST(ContactGaps, WhatNeverStandsIsNotFollowedForEver) {
  const Leg leg;
  ContactGaps gaps(leg.mechanism, leg.scene);
  int changes = 0;
  for (int i = 0; i < 1000; ++i) {
    changes += gaps.take(motionOf({0.4 + (i % 2 == 0 ? 0.001 : -0.001), 0}, {0, 0}, {0, 0}));
  }
  EXPECT_GT(changes, 10);
  EXPECT_LE(changes, 100);
}

TEST(ContactGaps, GapsThatCannotBeAreRefused) {
  const auto refusal = [](const std::string& gap) {
    try {
      const Scene scene =
          sceneOf("contacts: [{name: c, link: link_2, plane: {link: link_0}, gap: " + gap + "}]");
      ClosedLoopDynamics(Leg().mechanism, scene, {});
    } catch (const SceneError& error) {
      return std::string(error.what());
    }
    return std::string("not refused");
  };
  EXPECT_EQ(refusal("{close: 0.002, open: 0.002}"),
            "contacts: 'c': gap: close = 0.002 is not less than open = 0.002");
  EXPECT_EQ(refusal("{close: 0.002}"), "contacts[0].gap: open is missing");
}

}  // namespace
}  // namespace virtual_work_dynamics
