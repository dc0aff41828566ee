#include "generate/recorder.h"

#include <algorithm>

#include "generate/recorded_number.h"
#include "tree/applied_at.h"
#include "tree/kernel/joint_angles.h"
#include "tree/plan_run.h"

namespace virtual_work_dynamics {

namespace {

// Numbers of an array, in which terms may stand.
using Numbers = std::vector<double>;

void put(Numbers& numbers, std::size_t at, const Term& term) {
  std::memcpy(&numbers[at], &term, sizeof term);
}

Term termAt(const Numbers& numbers, std::size_t at) {
  return Term(numbers[at]);
}

// Adds an array of inputs, if it has any numbers, and puts terms in their places.
void inputArray(RecordedPlan& recording, const NamedArray& array, Numbers& numbers) {
  if (array.count == 0) return;
  const int index = static_cast<int>(recording.inputs.size());
  recording.inputs.push_back(array);
  for (int i = 0; i < array.count; ++i) {
    put(numbers, static_cast<std::size_t>(i), recording.graph.input(index, i));
  }
}

// Turns applied wrenches that a user gives into those that kernels read.
void applyWrenches(const Plan<double>& plan, Numbers& applied) {
  const Numbers given = applied;
  for (std::size_t i = 0; i < plan.applied.size(); ++i) {
    const auto vector = [&](std::size_t at) -> Vec3<Term> {
      return {termAt(given, at), termAt(given, at + 1), termAt(given, at + 2)};
    };
    const PlainWrench<Term> value =
        appliedAt(plan.applied[i], PlainWrench<Term>{vector(6 * i), vector(6 * i + 3)});
    std::size_t at = 6 * i;
    for (const Vec3<Term>* part : {&value.force, &value.torque}) {
      for (const Term& term : {part->x, part->y, part->z}) put(applied, at++, term);
    }
  }
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

// Adds an array of results, if it has any numbers.
void outputArray(RecordedPlan& recording, const NamedArray& array, const Numbers& numbers) {
  if (array.count == 0) return;
  const int index = static_cast<int>(recording.outputs.size());
  recording.outputs.push_back(array);
  for (int i = 0; i < array.count; ++i) {
    recording.graph.outputs.push_back({index, i, termAt(numbers, static_cast<std::size_t>(i))});
  }
}

class GraphInUse {
 public:
  explicit GraphInUse(ExpressionGraph& graph) { recorded = &graph; }
  ~GraphInUse() { recorded = nullptr; }
};

}  // namespace

bool RecordedPlan::anyRest() const {
  return std::any_of(graph.angles().begin(), graph.angles().end(),
                     [](const Angle& angle) { return !angle.rest.is(0); });
}

RecordedPlan record(const Plan<double>& plan) {
  RecordedPlan recording;
  const GraphInUse in_use(recording.graph);
  SampleArrays arrays(plan);
  const int coordinates = plan.coordinates;
  const auto input = [&](const char* name, int count, const char* says, Numbers& numbers) {
    inputArray(recording, {name, count, says}, numbers);
  };
  input("q", coordinates, "positions, rad or m", arrays.q);
  input("qd", coordinates, "velocities, rad/s or m/s", arrays.qd);
  input("qdd", coordinates, "accelerations, rad/s^2 or m/s^2", arrays.qdd);
  input("root", plan.root_moves ? RootState::kNumbers : 0,
        "of the root link, in its axes: angular velocity, angular acceleration, acceleration less "
        "gravity",
        arrays.root);
  input("orientations", 4 * plan.orientations,
        "x y z w of each joint that turns freely, of unit length", arrays.orientations);
  input("applied", 6 * static_cast<int>(plan.applied.size()),
        "force and torque of each applied wrench, N and N m, as the scene gives them",
        arrays.applied);
  applyWrenches(plan, arrays.applied);
  runPlan<Term>(plan, arrays, [&](const auto& view, const auto& in, const auto& scratch) {
    recordAngles(view, in, scratch, recording.graph);
  });

  const int child_count = 6 * static_cast<int>(plan.child_axes.size());
  const int root_count = static_cast<int>(plan.root_axes.size());
  const bool both = child_count > 0 && root_count > 0;
  const char* const wrench = "fx fy fz tx ty tz of each, N and N m";
  outputArray(recording, {"effort", plan.efforts ? coordinates : 0, "N m or N"}, arrays.effort);
  outputArray(recording, {both ? "child_reactions" : "reactions", child_count, wrench},
              arrays.child_axes);
  outputArray(recording, {both ? "root_reactions" : "reactions", 6 * root_count, wrench},
              arrays.root_axes);
  outputArray(recording,
              {"poses", plan.poses ? 12 * root_count : 0,
               "of each joint: x y z, then its axes in the root link's by rows"},
              arrays.poses);
  outputArray(
      recording,
      {"twists", plan.twists ? 6 * root_count : 0, "of each joint: vx vy vz wx wy wz, root axes"},
      arrays.twists);
  return recording;
}

}  // namespace virtual_work_dynamics
