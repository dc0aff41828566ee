#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "closed_loops.h"
#include "four_bar.h"
#include "stability/mechanism_maker.h"
#include "stability/sweeps.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kRate = MotionRange().rate, kAcceleration = MotionRange().acceleration;
const Vector3l kAnyAxis = Vector3l(0.48L, -0.6L, 0.64L);

Matrix3l turn(long double angle, const Vector3l& axis) {
  return Eigen::AngleAxis<long double>(angle, axis).toRotationMatrix();
}

// A revolute joint at the end of a link that is an arc of a great circle: axes are radial.
struct Arc {
  long double radius, angle;

  Vector3l end() const {
    const long double half = std::sin(angle / 2);
    return {radius * std::sin(angle), 0, -2 * radius * half * half};
  }
  JointPlace place() const {
    return {JointType::kRevolute, Vector3l::UnitZ(), turn(angle, Vector3l::UnitY()), end()};
  }
  LinkFrame frame(const std::string& link) const {
    return {link, end().cast<double>(), {0, static_cast<double>(angle), 0}};
  }
};

// Has the passive joints of a motion follow the others, from the scene's assembly.
Motion completed(ClosedLoops& dynamics, Motion motion) {
  if (!dynamics.complete(motion)) throw Error("the four-bar of the scene is not closed");
  return motion;
}

// A spherical four-bar is mobile whatever its radius. Links are as FourBar's; `angle` is between
// the axes of the two pivots on ground.
StabilityCase sphericalFourBar(double angle) {
  const FourBar plane;
  const long double radius = plane.lengths[3] / angle;
  const auto arc = [&](int link) {
    return Arc{radius, plane.lengths[static_cast<std::size_t>(link)] / radius};
  };
  MechanismMaker maker(71);
  const Matrix3l base = turn(1.1L, kAnyAxis);
  JointPlace A, D = arc(3).place();
  A.R_PK = base;
  D.R_PK = base * D.R_PK;
  D.p_PoKo_P = base * D.p_PoKo_P;
  const auto body = [&](int link) {
    return maker.cuboid(1, static_cast<double>(plane.lengths[static_cast<std::size_t>(link)]));
  };
  const int crank = maker.add(0, A, body(FourBar::kCrank));
  maker.add(crank, arc(FourBar::kCrank).place(), body(FourBar::kCoupler));
  maker.add(0, D, body(FourBar::kRocker));
  Scene scene;
  scene.closures = {{"C",
                     ClosureType::kRevolute,
                     arc(FourBar::kCoupler).frame("link_2"),
                     arc(FourBar::kRocker).frame("link_3"),
                     {}}};
  scene.actuated = std::vector<std::string>{"joint_1"};
  const auto in_plane = [plane](const FourBar::Turning& crank_turning) {
    const auto t =
        plane.turnings(crank_turning.angle, crank_turning.rate, crank_turning.acceleration);
    Motion motion(3);
    motion.q << static_cast<double>(t[0].angle), static_cast<double>(t[1].angle - t[0].angle),
        static_cast<double>(t[2].angle);
    motion.qd[0] = static_cast<double>(t[0].rate);
    motion.qdd[0] = static_cast<double>(t[0].acceleration);
    return motion;
  };
  const Motion start = in_plane({0.8L, 0, 0});
  for (int i = 0; i < 3; ++i) {
    scene.assembly.push_back({"joint_" + std::to_string(i + 1), start.q[i]});
  }
  const Mechanism mechanism = maker.mechanism("spherical four-bar");
  const auto dynamics = std::make_shared<ClosedLoops>(mechanism, scene);
  const auto motion = [in_plane, dynamics](RandomNumbers& random) {
    const double angle_of_crank = random.uniform(-3, 3), rate = random.uniform(-kRate, kRate);
    const double acceleration = random.uniform(-kAcceleration, kAcceleration);
    return completed(*dynamics, in_plane({angle_of_crank, rate, acceleration}));
  };
  return {mechanism, scene, motion};
}

// A body on two passive gimbals, along whose axis a cylinder of a driven fork slides: both turn
// about x by one angle, which is the angle between the outer gimbal's axis and the body's.
StabilityCase gimbals(double angle) {
  constexpr double kSize = 0.3;  // m
  MechanismMaker maker(72);
  const Matrix3l base = turn(1.1L, kAnyAxis);
  JointPlace outer, inner, fork;
  outer.R_PK = fork.R_PK = base;
  inner.axis_K = fork.axis_K = Vector3l::UnitX();
  const int frame = maker.add(0, outer, maker.cuboid(1, kSize));
  maker.add(frame, inner, maker.cuboid(1, kSize));
  maker.add(0, fork, maker.cuboid(1, kSize));
  Scene scene;
  const Eigen::Vector3d at(0, 0, kSize);
  scene.closures = {{"cylinder",
                     ClosureType::kCylindrical,
                     {"link_2", at, Eigen::Vector3d::Zero()},
                     {"link_3", at, Eigen::Vector3d::Zero()},
                     {}}};
  scene.actuated = std::vector<std::string>{"joint_3"};
  scene.assembly = {{"joint_2", 1}, {"joint_3", 1}};
  const auto motion = [angle](RandomNumbers& random) {
    const double sign = random.chance(0.5) ? 1 : -1;
    Motion state(3);
    state.q[1] = state.q[2] = sign * random.uniform(0.5 * angle, angle);
    state.qd[1] = state.qd[2] = random.uniform(-kRate, kRate);
    state.qdd[1] = state.qdd[2] = random.uniform(-kAcceleration, kAcceleration);
    return state;
  };
  return {maker.mechanism("gimbals"), scene, motion};
}

// Rods side by side on ground, each joined to the next by a coupler; all rods stay parallel.
StabilityCase ladder(double couplers) {
  constexpr double kRod = 0.3, kPitch = 0.2;  // m
  const int count = static_cast<int>(couplers);
  MechanismMaker maker(73);
  const Matrix3l base = turn(1.1L, kAnyAxis);
  Scene scene;
  std::vector<bool> is_rod;
  for (int i = 0; i <= count; ++i) {
    JointPlace foot, end;
    foot.R_PK = base;
    foot.p_PoKo_P = base * Vector3l(kPitch * i, 0, 0);
    const int rod = maker.add(0, foot, maker.cuboid(1, kRod));
    is_rod.push_back(true);
    const std::string name = "link_" + std::to_string(rod);
    if (i > 0) {
      const Eigen::Vector3d far_end(kPitch, 0, 0), tip(kRod, 0, 0), unturned(0, 0, 0);
      scene.closures.push_back({"closure_" + std::to_string(i),
                                ClosureType::kRevolute,
                                {"link_" + std::to_string(rod - 1), far_end, unturned},
                                {name, tip, unturned},
                                {}});
    }
    if (i == count) break;
    end.p_PoKo_P << kRod, 0, 0;
    maker.add(rod, end, maker.cuboid(1, kPitch));
    is_rod.push_back(false);
  }
  scene.actuated = std::vector<std::string>{"joint_1"};
  for (std::size_t k = 0; k < is_rod.size(); ++k) {
    scene.assembly.push_back({"joint_" + std::to_string(k + 1), is_rod[k] ? 1.0 : -1.0});
  }
  const auto motion = [is_rod](RandomNumbers& random) {
    const double q = random.uniform(0.6, 2.5), qd = random.uniform(-kRate, kRate);
    const double qdd = random.uniform(-kAcceleration, kAcceleration);
    Motion state(static_cast<Eigen::Index>(is_rod.size()));
    for (Eigen::Index i = 0; i < state.q.size(); ++i) {
      const double sign = is_rod[static_cast<std::size_t>(i)] ? 1 : -1;
      state.q[i] = sign * q;
      state.qd[i] = sign * qd;
      state.qdd[i] = sign * qdd;
    }
    return state;
  };
  return {maker.mechanism("ladder"), scene, motion};
}

}  // namespace

std::vector<Sweep> linkageSweeps() {
  return {
      {"loop_parallel_axes", "angle between the axes of the pivots on ground [rad]",
       powersOfTen(-16, 0), sphericalFourBar},
      {"loop_gimbals", "angles between the outer and the last axis up to [rad]",
       powersOfTen(-16, 0), gimbals},
      {"loop_ladder", "four-bars side by side", {1, 2, 5, 10, 20}, ladder},
  };
}

}  // namespace virtual_work_dynamics
