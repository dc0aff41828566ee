#include "generate/recorder.h"

#include <algorithm>

#include "base/aligned_memory.h"
#include "generate/recorded_number.h"
#include "tree/applied_at.h"
#include "tree/kernel/joint_angles.h"
#include "tree/kernel/scratch.h"
#include "virtual_work_dynamics/root_motion.h"

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

// Adds an array of inputs, if it has any numbers, and returns what stands for them.
Numbers inputArray(RecordedPlan& recording, const NamedArray& array) {
  Numbers numbers(static_cast<std::size_t>(array.count) + 1);
  if (array.count == 0) return numbers;
  const int index = static_cast<int>(recording.inputs.size());
  recording.inputs.push_back(array);
  for (int i = 0; i < array.count; ++i) {
    put(numbers, static_cast<std::size_t>(i), recording.graph.input(index, i));
  }
  return numbers;
}

// The applied wrenches as kernels read them, of those that a user gives.
Numbers appliedArray(const Plan<double>& plan, const Numbers& given) {
  Numbers applied(given.size());
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
  const PlanView<double> view = viewOf(plan);
  ScratchDealer counting(nullptr);
  dealScratch<Term>(view, 0, counting);
  const AlignedMemory memory(counting.used());
  ScratchDealer dealer(memory.get());
  const Scratch<Term, double> scratch = dealScratch<Term>(view, 0, dealer);
  prepareScratch(view, 0, scratch);

  RecordedPlan recording;
  const GraphInUse in_use(recording.graph);
  const int coordinates = plan.coordinates;
  const auto input = [&](const char* name, int count, const char* says) {
    return inputArray(recording, {name, count, says});
  };
  const Numbers q = input("q", coordinates, "positions, rad or m");
  const Numbers qd = input("qd", coordinates, "velocities, rad/s or m/s");
  const Numbers qdd = input("qdd", coordinates, "accelerations, rad/s^2 or m/s^2");
  const Numbers root = input("root", plan.root_moves ? RootState::kNumbers : 0,
                             "of the root link, in its axes: angular velocity, angular "
                             "acceleration, acceleration less gravity");
  const Numbers orientations = input("orientations", 4 * plan.orientations,
                                     "x y z w of each joint that turns freely, of unit length");
  const Numbers applied = appliedArray(
      plan, input("applied", 6 * static_cast<int>(plan.applied.size()),
                  "force and torque of each applied wrench, N and N m, as the scene gives them"));
  const KernelInputs<double> in = {
      q.data(),    qd.data(), qdd.data(),          1, applied.data(), 1,
      root.data(), 1,         orientations.data(), 1};
  const int child_count = 6 * static_cast<int>(plan.child_axes.size());
  const int root_count = static_cast<int>(plan.root_axes.size());
  const auto room = [](int count) { return Numbers(static_cast<std::size_t>(count) + 1); };
  Numbers effort = room(coordinates), child = room(child_count), in_root = room(6 * root_count),
          poses = room(12 * root_count), twists = room(6 * root_count);
  const KernelOutputs<double> out = {plan.efforts ? effort.data() : nullptr,
                                     child.data(),
                                     in_root.data(),
                                     plan.poses ? poses.data() : nullptr,
                                     plan.twists ? twists.data() : nullptr,
                                     1};
  recordAngles(view, in, scratch, recording.graph);
  evaluate(view, in, out, scratch);

  outputArray(recording, {"effort", plan.efforts ? coordinates : 0, "N m or N"}, effort);
  const char* const wrench = "fx fy fz tx ty tz of each, N and N m";
  const bool both = child_count > 0 && root_count > 0;
  outputArray(recording, {both ? "child_reactions" : "reactions", child_count, wrench}, child);
  outputArray(recording, {both ? "root_reactions" : "reactions", 6 * root_count, wrench}, in_root);
  outputArray(recording,
              {"poses", plan.poses ? 12 * root_count : 0,
               "of each joint: x y z, then its axes in the root link's by rows"},
              poses);
  outputArray(
      recording,
      {"twists", plan.twists ? 6 * root_count : 0, "of each joint: vx vy vz wx wy wz, root axes"},
      twists);
  return recording;
}

}  // namespace virtual_work_dynamics
