#include "generate/recorder.h"

#include <algorithm>

#include "generate/recorded_number.h"
#include "tree/applied_at.h"
#include "tree/kernel/joint_angles.h"
#include "tree/plan_run.h"

namespace virtual_work_dynamics {

namespace {

using Terms = std::vector<Term>;

// Terms of an array, to stand in the places of its numbers, one more of them.
void put(const Terms& terms, std::vector<double>& numbers) {
  if (!terms.empty()) std::memcpy(numbers.data(), terms.data(), sizeof(Term) * terms.size());
}

Terms taken(const std::vector<double>& numbers, std::size_t count) {
  Terms terms;
  for (std::size_t i = 0; i < count; ++i) terms.emplace_back(numbers[i]);
  return terms;
}

// Turns applied wrenches that a user gives into those that kernels read.
Terms appliedWrenches(const Plan<double>& plan, const Terms& given) {
  Terms applied;
  for (std::size_t i = 0; i < plan.applied.size(); ++i) {
    const auto vector = [&](std::size_t at) -> Vec3<Term> {
      return {given[at], given[at + 1], given[at + 2]};
    };
    const PlainWrench<Term> value =
        appliedAt(plan.applied[i], PlainWrench<Term>{vector(6 * i), vector(6 * i + 3)});
    for (const Vec3<Term>* part : {&value.force, &value.torque}) {
      applied.insert(applied.end(), {part->x, part->y, part->z});
    }
  }
  return applied;
}

// As the kernels find them, see joint_angles.h.
void recordAngles(const PlanView<double>& view, const KernelInputs<double>& in,
                  const Scratch<Term, double>& scratch, ExpressionGraph& graph) {
  for (int i = 0; i < view.angle_count; ++i) {
    const JointPosition<double>& joint = view.angles[i];
    Angle angle;
    angle.angle = angleOf(joint, in, angle.rest);
    Term &cosine = scratch.cosines[i], &sine = scratch.sines[i];
    cosine = graph.part(kCosine, angle);
    sine = graph.part(kSine, angle);
    if (joint.geared) turnByRest<double>(graph.part(kRest, angle), cosine, sine);
    if (joint.turned) turnByPhase(joint.phase_cos, joint.phase_sin, cosine, sine);
  }
}

}  // namespace

GraphInUse::GraphInUse(ExpressionGraph& graph) {
  recorded = &graph;
}

GraphInUse::~GraphInUse() {
  recorded = nullptr;
}

bool RecordedPlan::anyRest() const {
  return std::any_of(graph.angles().begin(), graph.angles().end(),
                     [](const Angle& angle) { return !angle.rest.is(0); });
}

SampleTerms inputsOf(const Plan<double>& plan, std::size_t wrenches, RecordedPlan& recording) {
  const auto input = [&](const char* name, std::size_t count, const char* says) {
    Terms terms;
    if (count == 0) return terms;
    const int index = static_cast<int>(recording.inputs.size());
    recording.inputs.push_back({name, static_cast<int>(count), says});
    for (std::size_t i = 0; i < count; ++i) {
      terms.push_back(recording.graph.input(index, static_cast<int>(i)));
    }
    return terms;
  };
  const auto coordinates = static_cast<std::size_t>(plan.coordinates);
  SampleTerms terms;
  terms.q = input("q", coordinates, "positions, rad or m");
  terms.qd = input("qd", coordinates, "velocities, rad/s or m/s");
  terms.qdd = input("qdd", coordinates, "accelerations, rad/s^2 or m/s^2");
  terms.root = input("root", plan.root_moves ? RootState::kNumbers : 0,
                     "of the root link, in its axes: angular velocity, angular acceleration, "
                     "acceleration less gravity");
  terms.orientations = input("orientations", 4 * static_cast<std::size_t>(plan.orientations),
                             "x y z w of each joint that turns freely, of unit length");
  terms.applied =
      input("applied", 6 * wrenches,
            "force and torque of each applied wrench, N and N m, as the scene gives them");
  terms.applied.resize(6 * plan.applied.size(), Term(0));
  return terms;
}

void runOnTerms(const Plan<double>& plan, SampleTerms& terms, RecordedPlan& recording) {
  SampleArrays arrays(plan);
  put(terms.q, arrays.q);
  put(terms.qd, arrays.qd);
  put(terms.qdd, arrays.qdd);
  put(terms.root, arrays.root);
  put(terms.orientations, arrays.orientations);
  put(appliedWrenches(plan, terms.applied), arrays.applied);
  runPlan<Term>(plan, arrays, [&](const auto& view, const auto& in, const auto& scratch) {
    recordAngles(view, in, scratch, recording.graph);
  });
  const std::size_t child_axes = plan.child_axes.size(), root_axes = plan.root_axes.size();
  terms.effort =
      taken(arrays.effort, plan.efforts ? static_cast<std::size_t>(plan.coordinates) : 0);
  terms.child_axes = taken(arrays.child_axes, 6 * child_axes);
  terms.root_axes = taken(arrays.root_axes, 6 * root_axes);
  terms.poses = taken(arrays.poses, plan.poses ? 12 * root_axes : 0);
  terms.twists = taken(arrays.twists, plan.twists ? 6 * root_axes : 0);
}

void addOutputs(RecordedPlan& recording, const NamedArray& array, const Terms& terms) {
  if (terms.empty()) return;
  const int index = static_cast<int>(recording.outputs.size());
  recording.outputs.push_back(array);
  recording.outputs.back().count = static_cast<int>(terms.size());
  for (std::size_t i = 0; i < terms.size(); ++i) {
    recording.graph.outputs.push_back({index, static_cast<int>(i), terms[i]});
  }
}

void addReactions(RecordedPlan& recording, const Terms& child_axes, const Terms& root_axes) {
  const bool both = !child_axes.empty() && !root_axes.empty();
  const char* const wrench = "fx fy fz tx ty tz of each, N and N m";
  addOutputs(recording, {both ? "child_reactions" : "reactions", 0, wrench}, child_axes);
  addOutputs(recording, {both ? "root_reactions" : "reactions", 0, wrench}, root_axes);
}

RecordedPlan record(const Plan<double>& plan) {
  RecordedPlan recording;
  const GraphInUse in_use(recording.graph);
  SampleTerms terms = inputsOf(plan, plan.applied.size(), recording);
  runOnTerms(plan, terms, recording);
  addOutputs(recording, {"effort", 0, "N m or N"}, terms.effort);
  addReactions(recording, terms.child_axes, terms.root_axes);
  addOutputs(recording,
             {"poses", 0, "of each joint: x y z, then its axes in the root link's by rows"},
             terms.poses);
  addOutputs(recording, {"twists", 0, "of each joint: vx vy vz wx wy wz, root axes"}, terms.twists);
  return recording;
}

}  // namespace virtual_work_dynamics
