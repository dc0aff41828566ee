#include "tree/plan_counting.h"

#include "tree/kernel/joint_angles.h"
#include "tree/plan_run.h"

namespace virtual_work_dynamics {

namespace {

struct Operations {
  std::size_t multiplications = 0;
  std::size_t additions = 0;
};
thread_local Operations counted;

/// A double that counts what is done with it.
struct Counted {
  double value;

  Counted() = default;
  explicit Counted(double v) : value(v) {}
};

Counted operator+(const Counted& a, const Counted& b) {
  ++counted.additions;
  return Counted(a.value + b.value);
}
Counted operator-(const Counted& a, const Counted& b) {
  ++counted.additions;
  return Counted(a.value - b.value);
}
Counted operator-(const Counted& a) {
  return Counted(-a.value);
}
Counted operator*(const Counted& a, const Counted& b) {
  ++counted.multiplications;
  return Counted(a.value * b.value);
}
Counted operator*(double a, const Counted& b) {
  return Counted(a) * b;
}
Counted operator*(const Counted& a, double b) {
  return a * Counted(b);
}
Counted productRest(double a, const Counted& b, const Counted& product) {
  return a * b - product;
}
// Comparisons are not counted.
Counted heldWithinOne(const Counted& a) {
  return a;
}
Counted uncounted(const Counted& a) {
  return a;
}

// "what (2): name, name".
std::string listed(const char* what, const std::vector<std::string>& names) {
  std::string line = std::string(what) + " (" + std::to_string(names.size()) + "): ";
  for (std::size_t i = 0; i < names.size(); ++i) line += (i ? ", " : "") + names[i];
  return line;
}

std::vector<std::string> linesOf(const Plan<double>& plan) {
  const OmittedWork& out = plan.left_out;
  std::vector<std::string> lines;
  const auto list = [&](const char* what, const std::vector<std::string>& names) {
    if (!names.empty()) lines.push_back(listed(what, names));
  };
  list("fixed joints, merged into their parents", out.merged);
  list("joints that reach no requested result", out.unneeded);
  list("reactions that are zero, as nothing with mass and no applied wrench hangs on them",
       out.massless);
  list("positions that matter to no requested result", out.idle);
  list("motion of the parent, which rests", out.at_rest);
  if (out.velocity_terms) lines.push_back("velocities and accelerations: the scene is static");
  if (out.gravity) lines.push_back("gravity: it is zero");
  if (!plan.efforts) lines.push_back("efforts: not requested");
  if (plan.child_axes.empty()) lines.push_back("reactions in link axes: not requested");
  if (plan.root_axes.empty()) lines.push_back("reactions in root axes: not requested");
  if (!plan.any_pose) lines.push_back("poses: nothing requested needs them");
  return lines;
}

}  // namespace

PlanSummary summarize(const Plan<double>& plan) {
  SampleArrays arrays(plan);
  counted = {};
  runPlan<Counted>(plan, arrays, [](const auto& view, const auto& in, const auto& scratch) {
    plainAngles(view, in, scratch, uncounted, uncounted);
  });

  PlanSummary summary;
  summary.bodies = plan.bodies.size();
  summary.multiplications = counted.multiplications;
  summary.additions = counted.additions;
  summary.sines_and_cosines = plan.angles.size();
  summary.left_out = linesOf(plan);
  return summary;
}

std::vector<std::string> PlanSummary::lines() const {
  std::vector<std::string> lines = {
      "one sample: " + std::to_string(multiplications) + " multiplications, " +
      std::to_string(additions) + " additions, " + std::to_string(sines_and_cosines) +
      " sines and cosines; bodies, with the root: " + std::to_string(bodies)};
  for (const std::string& line : left_out) lines.push_back("left out: " + line);
  return lines;
}

}  // namespace virtual_work_dynamics
