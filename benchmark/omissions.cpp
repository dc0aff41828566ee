#include "omissions.h"

#include <algorithm>

namespace virtual_work_dynamics {
namespace {

std::vector<std::string> jointNames(const Mechanism& mechanism, bool fixed_ones) {
  std::vector<std::string> names;
  for (const Joint& joint : mechanism.joints()) {
    if (fixed_ones || joint.type != JointType::kFixed) names.push_back(joint.name);
  }
  return names;
}

Request everything(const std::vector<std::string>& joints) {
  Request request;
  request.child_axes = request.root_axes = joints;
  request.poses = request.twists = true;
  return request;
}

// The movable joint with most joints between it and the root; of several, the first.
std::string outermostJoint(const Mechanism& mechanism) {
  std::vector<int> depths(mechanism.links().size(), 0);
  int deepest = -1;
  for (std::size_t k = 0; k < mechanism.joints().size(); ++k) {
    const Joint& joint = mechanism.joints()[k];
    const bool moves = joint.type != JointType::kFixed;
    depths[k + 1] = depths[joint.parent_link] + (moves ? 1 : 0);
    if (moves && (deepest < 0 || depths[k + 1] > depths[deepest + 1])) {
      deepest = static_cast<int>(k);
    }
  }
  return mechanism.joints().at(deepest).name;
}

Joint slider(const std::string& name) {
  Joint joint;
  joint.name = name;
  joint.type = JointType::kPrismatic;
  joint.axis_K = Vector3l::UnitZ();
  joint.coordinate = 0;
  return joint;
}

// The same robot standing on a platform that a joint can lift; its coordinate is the first.
Mechanism onLift(const Mechanism& mechanism) {
  Link rail;
  rail.name = "lift_rail";
  std::vector<Link> links{rail};
  for (Link link : mechanism.links()) {
    ++link.parent_joint;  // the root link hangs on the lift, joint 0
    links.push_back(link);
  }
  std::vector<Joint> joints{slider("lift")};
  joints[0].child_link = 1;
  for (Joint joint : mechanism.joints()) {
    ++joint.parent_link;
    ++joint.child_link;
    if (joint.coordinate >= 0) ++joint.coordinate;
    joints.push_back(joint);
  }
  return Mechanism(mechanism.name() + "_on_lift", std::move(links), std::move(joints));
}

void addMasslessLink(const std::string& name, const Vector3l& axis, std::vector<Link>& links,
                     std::vector<Joint>& joints, int coordinate) {
  Joint joint;
  joint.name = name;
  joint.type = JointType::kContinuous;
  joint.parent_link = static_cast<int>(links.size()) - 1;
  joint.child_link = joint.parent_link + 1;
  joint.p_PoKo_P << 0.02L, -0.01L, 0.05L;
  joint.axis_K = axis;
  joint.coordinate = coordinate;
  Link link;
  link.name = name + "_link";
  link.parent_joint = static_cast<int>(joints.size());
  joints.push_back(joint);
  links.push_back(link);
}

Scene sceneWithGravity(const Eigen::Vector3d& gravity) {
  Scene scene;
  scene.gravity = gravity;
  return scene;
}

}  // namespace

OmissionScene omissionsOf(const BenchmarkScene& benchmark_scene) {
  const Mechanism& mechanism = benchmark_scene.mechanism;
  const Scene scene = sceneWithGravity(benchmark_scene.gravity);
  const std::vector<std::string> movable = jointNames(mechanism, false);
  const Request full = everything(movable);
  const auto plan = [&](const Scene& wanted, const Request& request) {
    return std::make_shared<const NamedPlan>(mechanism, wanted, request);
  };

  OmissionScene result{benchmark_scene.name, {}};
  std::vector<Omission>& list = result.omissions;
  const std::vector<std::string> all_joints = jointNames(mechanism, true);
  list.push_back({"nothing", plan(scene, everything(all_joints)), nullptr});
  if (all_joints.size() > movable.size()) {
    list.push_back({"reactions of fixed joints", plan(scene, full), list[0].plan});
  }
  const std::shared_ptr<const NamedPlan> whole = list.back().plan;

  Request request;
  request.child_axes = movable;
  list.push_back({"reactions in root axes with poses and twists", plan(scene, request), whole});
  list.push_back({"all reactions", plan(scene, Request()), whole});
  request = Request();
  request.efforts = false;
  request.child_axes = {outermostJoint(mechanism)};
  list.push_back({"efforts and all reactions but that of " + request.child_axes[0],
                  plan(scene, request), whole});
  Scene at_rest = scene;
  at_rest.static_motion = true;
  list.push_back({"velocities and accelerations", plan(at_rest, full), whole, true});
  const Scene weightless = sceneWithGravity(Eigen::Vector3d::Zero());
  list.push_back({"gravity", plan(weightless, full),
                  std::make_shared<const NamedPlan>(onLift(mechanism), weightless, full)});
  return result;
}

OmissionScene masslessLeavesOf(const BenchmarkScene& benchmark_scene) {
  const Mechanism& bare = benchmark_scene.mechanism;
  std::vector<Link> links = bare.links();
  std::vector<Joint> joints = bare.joints();
  const int coordinates = static_cast<int>(bare.coordinates().size());
  addMasslessLink("pan", Vector3l::UnitZ(), links, joints, coordinates);
  addMasslessLink("tilt", Vector3l::UnitY(), links, joints, coordinates + 1);
  const Mechanism mechanism(bare.name() + "_massless_tool", std::move(links), std::move(joints));

  const Scene scene = sceneWithGravity(benchmark_scene.gravity);
  // A wrench of zero may change from sample to sample, so that its link has to stay.
  Scene loaded = scene;
  for (const char* link : {"pan_link", "tilt_link"}) {
    loaded.applied_wrenches.emplace_back();
    loaded.applied_wrenches.back().link = link;
  }
  const Request full = everything(jointNames(mechanism, false));
  const auto with = std::make_shared<const NamedPlan>(mechanism, loaded, full);
  const auto without = std::make_shared<const NamedPlan>(mechanism, scene, full);
  return {benchmark_scene.name + "_massless_tool",
          {{"nothing", with, nullptr}, {"massless leaves", without, with}}};
}

}  // namespace virtual_work_dynamics
