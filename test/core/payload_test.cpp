#include <gtest/gtest.h>

#include <string>

#include "bounded_wrenches.h"
#include "robot_builder.h"
#include "virtual_work_dynamics/certificates.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/error_bound.h"
#include "virtual_work_dynamics/lagrange_dynamics.h"
#include "virtual_work_dynamics/scene_reader.h"

namespace virtual_work_dynamics {
namespace {

Scene sceneOf(const std::string& text) {
  return readScene(YAML::Load(text));
}

Payload randomPayload(RobotBuilder& builder, const std::string& link) {
  Payload payload;
  payload.link = link;
  payload.mass = builder.uniform(0.5, 4);
  payload.at = builder.vector(0.4).cast<double>();
  const Eigen::Vector3d half = builder.vector(0.2).cwiseAbs().cast<double>();  // of a box
  const Eigen::Matrix3d R = builder.rotation().cast<double>();
  const Eigen::Vector3d squares = half.cwiseProduct(half);
  const Eigen::Vector3d moments =
      (Eigen::Vector3d::Constant(squares.sum()) - squares) * (payload.mass / 3);
  payload.inertia = R * moments.asDiagonal() * R.transpose();
  payload.inertia = (payload.inertia + payload.inertia.transpose().eval()) / 2;
  return payload;
}

/// A tree of four joints; a scene in which some of its links carry payloads; and the same tree with
/// links that fixed joints carry in their place.
struct Loaded {
  explicit Loaded(unsigned seed) : builder(seed) {
    int link = 0;
    for (int i = 0; i < 4; ++i) link = builder.add(i == 2 ? 1 : link);
    motion = builder.motion();
    bare = builder.build();
    std::vector<Link> links = bare.links();
    std::vector<Joint> joints = bare.joints();
    for (const std::string name : {"link_2", "link_4", "link_4"}) {
      scene.payloads.push_back(randomPayload(builder, name));
    }
    // What the oracle has is added up about the link's origin, the other way than the library's.
    for (const Payload& payload : scene.payloads) {
      Link& own = links[static_cast<std::size_t>(bare.linkIndex(payload.link))];
      const auto about = [](long double m, const Vector3l& c) {
        return Matrix3l(m * (c.dot(c) * Matrix3l::Identity() - c * c.transpose()));
      };
      const Vector3l at = payload.at.cast<long double>();
      const Matrix3l I = own.inertia_Cm_K + about(own.mass, own.p_KoCm_K) +
                         payload.inertia.cast<long double>() + about(payload.mass, at);
      const Vector3l first = own.mass * own.p_KoCm_K + payload.mass * at;
      own.mass += payload.mass;
      own.p_KoCm_K = first / own.mass;
      own.inertia_Cm_K = I - about(own.mass, own.p_KoCm_K);
    }
    welded = Mechanism("welded", links, joints);
  }

  Request request() const {
    Request all;
    all.child_axes = {kGround, "joint_1", "joint_2", "joint_3", "joint_4"};
    return all;
  }

  RobotBuilder builder;
  Motion motion;
  Mechanism bare{"none", {Link()}, {}}, welded{"none", {Link()}, {}};
  Scene scene;
};

TEST(Payload, IsThatOfALinkWithItsInertia) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Loaded loaded(seed);
    const Request request = loaded.request();
    const InverseDynamics carries(loaded.bare, loaded.scene, request);
    const InverseDynamics has(loaded.welded, Scene(), request);
    Workspace a = carries.makeWorkspace(), b = has.makeWorkspace();
    carries.compute(loaded.motion, a);
    has.compute(loaded.motion, b);
    ErrorBound bound(loaded.bare, loaded.scene);
    bound.compute(loaded.motion);
    expectTheSame(a.childAxes(), b.childAxes(), 1e-15, bound);
    LagrangeDynamics<double> lagrange(loaded.bare, loaded.scene, request);
    lagrange.compute(loaded.motion);
    EXPECT_LE((lagrange.effort() - a.effort()).cwiseAbs().maxCoeff(), 1e-12);
    Certifier certifier(loaded.bare, loaded.scene);
    EXPECT_LE(certifier.check(loaded.motion, a.effort(), a.childAxes()[0]).largest(), 1e-14);
    // All of it counts: without any one of them the results are others.
    for (std::size_t left_out = 0; left_out < loaded.scene.payloads.size(); ++left_out) {
      Scene fewer = loaded.scene;
      fewer.payloads.erase(fewer.payloads.begin() + static_cast<std::ptrdiff_t>(left_out));
      const InverseDynamics without(loaded.bare, fewer, request);
      Workspace c = without.makeWorkspace();
      without.compute(loaded.motion, c);
      EXPECT_GT((c.effort() - a.effort()).norm(), 1e-3);
    }
  }
}

TEST(Payload, IsReadFromTheScene) {
  const Scene scene = sceneOf(
      "payload:\n  - {link: link_2, mass: 2.5, at: [0.1, 0.2, 0.3], "
      "inertia: [0.03, 0.001, 0.002, 0.04, 0.003, 0.05]}\n  - {link: link_1, mass: 1}\n");
  ASSERT_EQ(scene.payloads.size(), 2U);
  EXPECT_EQ(scene.payloads[0].link, "link_2");
  EXPECT_EQ(scene.payloads[0].mass, 2.5);
  EXPECT_EQ(scene.payloads[0].at, Eigen::Vector3d(0.1, 0.2, 0.3));
  Eigen::Matrix3d inertia;
  inertia << 0.03, 0.001, 0.002, 0.001, 0.04, 0.003, 0.002, 0.003, 0.05;
  EXPECT_EQ(scene.payloads[0].inertia, inertia);
  EXPECT_EQ(scene.payloads[1].at, Eigen::Vector3d::Zero());
  EXPECT_EQ(scene.payloads[1].inertia, Eigen::Matrix3d::Zero());
}

template <typename F>
std::string messageOf(const F& run) {
  try {
    run();
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

TEST(Payload, ThatNoBodyIsIsRefused) {
  const auto reading = [](const std::string& entry) {
    return messageOf([&] { sceneOf("payload: [" + entry + "]"); });
  };
  EXPECT_EQ(reading("{mass: 1}"), "payload[0]: names no link");
  EXPECT_EQ(reading("{link: link_1}"), "payload[0]: has no mass");
  EXPECT_EQ(reading("{link: link_1, mass: 1, inertia: [1, 2, 3]}"),
            "payload[0].inertia: expected a list of six numbers: ixx, ixy, ixz, iyy, iyz, izz");
  const Loaded loaded(1);
  const auto compiling = [&](const std::string& entry) {
    return messageOf([&] { InverseDynamics(loaded.bare, sceneOf("payload: [" + entry + "]")); });
  };
  EXPECT_EQ(compiling("{link: link_1, mass: 0}"), "payload[0].mass: 0 kg is not a positive mass");
  EXPECT_EQ(compiling("{link: link_1, mass: -2}"), "payload[0].mass: -2 kg is not a positive mass");
  EXPECT_EQ(compiling("{link: link_1, mass: 1, inertia: [1, 0, 0, 1, 0, 3]}"),
            "payload[0].inertia: principal moments of inertia break the triangle inequality "
            "(1, 1, 3 kg m^2)");
  EXPECT_EQ(compiling("{link: link_1, mass: 1, inertia: [-1, 0, 0, 1, 0, 1]}"),
            "payload[0].inertia: negative principal moment of inertia (-1, 1, 1 kg m^2)");
  const std::string unknown = compiling("{link: link_9, mass: 1}");
  EXPECT_NE(unknown.find("payload[0].link"), std::string::npos) << unknown;
  EXPECT_NE(unknown.find("'link_9'"), std::string::npos) << unknown;
}

}  // namespace
}  // namespace virtual_work_dynamics
