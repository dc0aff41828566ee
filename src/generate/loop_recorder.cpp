#include "generate/loop_recorder.h"

#include <algorithm>
#include <limits>
#include <string>

#include "algebra/kernel/front_solutions.h"
#include "base/printable.h"
#include "generate/loop_model.h"
#include "generate/recorded_choices.h"
#include "generate/term_vectors.h"
#include "loops/kernel/closures.h"
#include "scene/lookup.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

// In how many parts the builds for AVX2 and AVX-512 sum.
constexpr int kSums = kRowChunk;
using TermFronts = FrontSolutions<Term, Term, kSums>;

Terms zeros(std::size_t count) {
  return Terms(count, Term(0));
}

class LoopRecorder {
 public:
  LoopRecorder(const LoopModel& model, RecordedPlan& recording)
      : model_(model),
        kinematics_(model.solvers.kinematics),
        recording_(recording),
        links_(zeros(kLinkNumbers * model.mechanism.links().size())),
        frames_(zeros(kFrameNumbers * model.scene.closures.size())),
        phi_(zeros(static_cast<std::size_t>(kinematics_.conditions()))),
        turning_(phi_),
        A_(zeros(phi_.size() * model.mechanism.coordinates().size())),
        wrenches_(zeros(kWrenchNumbers * phi_.size())),
        closures_(zeros(kWrenchNumbers * model.scene.closures.size())) {
    for (std::size_t i = 0; i < 9; i += 4) links_[kLinkR + i] = Term(1);  // the root's axes
  }

  void record() {
    const std::size_t own = model_.scene.applied_wrenches.size();
    sample_ = inputsOf(model_.tree, own, recording_);
    place();
    for (std::size_t i = 0; i < model_.scene.springs.size(); ++i) push(i, 6 * (own + 2 * i));
    runOnTerms(model_.tree, sample_, recording_);
    const Term common = graph().failures();
    for (const Eigen::VectorXd& q : model_.usual) {
      graph().setValues(0, q.data());
      graph().setFailures(common);
      solve();
    }
    if (variants_.empty()) {
      throw SceneError(
          "no code can be generated, as the loops are singular, or close to it, at their assembly "
          "and beside it");
    }
    output();
  }

 private:
  ExpressionGraph& graph() const { return recording_.graph; }
  const Term* link(int index) const {
    return &links_[static_cast<std::size_t>(index * kLinkNumbers)];
  }
  const Term* frame(std::size_t closure) const { return &frames_[kFrameNumbers * closure]; }

  void place() {
    const LinksView view = kinematics_.links().view();
    Terms angles = zeros(2 * static_cast<std::size_t>(view.angle_count + kMostAngleLanes));
    placeLinks<1, Term>(view, numbersOf(sample_.q), numbersOf(angles), numbersOf(links_));
    for (std::size_t c = 0; c < model_.scene.closures.size(); ++c) {
      const std::size_t first = static_cast<std::size_t>(kinematics_.firstOf(c));
      placeClosure<Term>(kinematics_.closure(c).shape(), numbersOf(links_),
                         {numbersOf(phi_) + first, numbersOf(A_) + first, phi_.size(),
                          numbersOf(wrenches_) + kWrenchNumbers * first,
                          numbersOf(frames_) + kFrameNumbers * c, numbersOf(turning_) + first});
      if (kinematics_.closure(c).type() == ClosureType::kCylinder) placeCylinder(c);
    }
    for (std::size_t i = 0; i < model_.couplings.size(); ++i) {
      const std::size_t set = model_.scene.closures.size() + i;
      const std::size_t row = static_cast<std::size_t>(kinematics_.firstOf(set));
      for (const ResolvedCoupling::Term& term : model_.couplings[i].terms) {
        A_[row + static_cast<std::size_t>(term.coordinate) * phi_.size()] = Term(term.factor);
      }
    }
    if (!model_.scene.static_motion && anyDamping()) {
      moveLinks<Term>(view, numbersOf(sample_.qd), numbersOf(links_));
    }
  }

  bool anyDamping() const {
    for (const PointSpring& spring : model_.scene.springs) {
      if (spring.damping != 0) return true;
    }
    return false;
  }

  // Of the axes of P the code needs z only; see CylinderConditions::framesAt().
  void placeCylinder(std::size_t closure) {
    Term* const numbers = &frames_[kFrameNumbers * closure];
    const LinkKinematics::Frame& parent = kinematics_.closure(closure).parent();
    const LinkKinematics::Frame& child = kinematics_.closure(closure).child();
    putVector(numbers + kFramePo, pointOn(parent.link, parent.p_LoFo_L));
    putVector(numbers + kFrameCo, pointOn(child.link, child.p_LoFo_L));
    for (int i = 0; i < 3; ++i) {
      putVector(numbers + kFrameC + 3 * i,
                plainTurned(link(child.link) + kLinkR, child.R_LF.col(i)));
    }
    const TermVector r = vectorAt(numbers + kFrameCo) - vectorAt(numbers + kFramePo);
    const Term length = squareRoot(plainDot(r, r));
    graph().requireAbove(length, Term(0));
    putVector(numbers + kFrameP + 6, over(r, length));
  }

  TermVector pointOn(int of, const Eigen::Vector3d& at) const {
    return vectorAt(link(of) + kLinkO) + plainTurned(link(of) + kLinkR, at);
  }
  TermVector velocityOn(int of, const Eigen::Vector3d& at) const {
    const TermVector r = pointOn(of, at) - vectorAt(link(of) + kLinkO);
    return vectorAt(link(of) + kLinkV) + plainCross(vectorAt(link(of) + kLinkW), r);
  }

  // See PointSprings::force().
  void push(std::size_t i, std::size_t place) {
    const PointSpring& spring = model_.scene.springs[i];
    const int a = linkNamed(model_.mechanism, spring.link_a, "springs");
    const int b = linkNamed(model_.mechanism, spring.link_b, "springs");
    const TermVector r = pointOn(b, spring.at_b) - pointOn(a, spring.at_a);
    const Term largest = largerOf(largerOf(absolute(r.x), absolute(r.y)), absolute(r.z));
    const TermVector scaled = over(r, largest);
    const Term norm = squareRoot(plainDot(scaled, scaled));
    const Term pull = Term(spring.stiffness) * (largest * norm - Term(spring.rest_length));
    const bool pushes = spring.stiffness > 0 && spring.rest_length > 0;
    TermVector force;
    if (spring.damping == 0) {
      force = times(pull / norm, scaled);
    } else {
      const TermVector direction = over(scaled, norm);
      const TermVector rate = velocityOn(b, spring.at_b) - velocityOn(a, spring.at_a);
      force = times(pull + Term(spring.damping) * plainDot(direction, rate), direction);
    }
    if (pushes || spring.damping != 0) {
      graph().requireAbove(largest, Term(0));  // elsewhere it has no direction
    } else {
      const auto orNone = [&](const Term& x) { return wherePositive(largest, x, Term(0)); };
      force = {orNone(force.x), orNone(force.y), orNone(force.z)};
    }
    putVector(&sample_.applied[place], force);
    putVector(&sample_.applied[place + 6], TermVector{-force.x, -force.y, -force.z});
  }

  // Solves by what is chosen at the present values, unless others led to the same.
  void solve() {
    effort_ = zeros(model_.effortNames().size());
    std::fill(closures_.begin(), closures_.end(), Term(0));
    close_ = Term(0);
    openEfforts();
    for (const LoopForces& forces : model_.solvers.forces) {
      if (!solve(forces)) return;
    }
    const auto same = [&](const Variant& other) { return other.failures == graph().failures(); };
    if (std::any_of(variants_.begin(), variants_.end(), same)) return;
    Variant variant{graph().failures(), wherePositive(close_, Term(1), Term(0)), effort_, {}, {}};
    variant.child_axes = reactions(model_.child_axes, sample_.child_axes);
    variant.root_axes = reactions(model_.root_axes, sample_.root_axes);
    variants_.push_back(std::move(variant));
  }

  // Of actuated coordinates in no loop.
  void openEfforts() {
    std::vector<bool> open = model_.loops.actuated;
    for (const LoopGroup& group : model_.groups) {
      for (const int i : group.coordinates) open[static_cast<std::size_t>(i)] = false;
    }
    for (std::size_t i = 0; i < open.size(); ++i) {
      if (open[i]) effort_[i] = sample_.effort[i];
    }
  }

  // The entries of a set in the transpose of B; see LoopForces::setEntries().
  void setEntries(const LoopForces& forces, const LoopUnknowns& unknowns, std::size_t local,
                  Terms& entries) const {
    const LoopUnknowns::OfSet& own = unknowns.of_sets[local];
    const ScaledColumns columns = forces.columnsOf(local);
    const std::size_t first = static_cast<std::size_t>(kinematics_.firstOf(own.set));
    const auto rows = static_cast<std::size_t>(own.multipliers());
    Terms gathered;
    if (own.effort >= 0) gathered = generalizedEffort(own.set);
    for (int k = 0; k < columns.count; ++k) {
      const ScaledColumn& column = columns.columns[k];
      const auto coordinate = static_cast<std::size_t>(column.coordinate);
      Term* const to = &entries[static_cast<std::size_t>(column.place * columns.height)];
      for (std::size_t i = 0; i < rows; ++i) {
        const double factor = forces.unitsOf(local)[i] * column.factor;
        to[i] = factor * A_[first + i + coordinate * phi_.size()];
      }
      if (own.effort < 0) continue;
      to[rows] = Term(own.columns.back().unit) * gathered[coordinate] * Term(column.factor);
    }
  }

  // By coordinate, that of a unit effort about or along the free axis of a closure; see
  // LoopKinematics::addGeneralizedForce().
  Terms generalizedEffort(std::size_t closure) const {
    Terms force = zeros(model_.mechanism.coordinates().size());
    const bool slides = kinematics_.closure(closure).freeUnit() == Unit::kMetre;
    const TermVector axis = vectorAt(frame(closure) + kFrameP + 6);
    const TermVector at = vectorAt(frame(closure) + kFrameCo);
    for (const PathStep& step : kinematics_.path(closure)) {
      const int coordinate = kinematics_.links().coordinateOf(step);
      if (coordinate < 0) continue;
      const JointShape& joint = kinematics_.links().view().joints[step.joint];
      const Term* const moved = link(step.joint + 1);
      const TermVector along = times(Term(step.sign * joint.multiplier), vectorAt(moved + kLinkZ));
      const bool joint_slides = joint.kind == JointKind::kSlides;
      Term work(0);
      if (slides) {
        work =
            plainDot(joint_slides ? along : plainCross(along, at - vectorAt(moved + kLinkO)), axis);
      } else if (!joint_slides) {
        work = plainDot(along, axis);
      }
      Term& sum = force[static_cast<std::size_t>(coordinate)];
      sum = sum + work;
    }
    return force;
  }

  // See LoopForces::setPosition() and solve(). Returns whether that is straight at the present
  // values.
  bool solve(const LoopForces& forces) {
    const LoopUnknowns unknowns(model_.mechanism, kinematics_, model_.loops, forces.group(),
                                model_.length);
    const MultifrontalQr& qr = forces.factorization();
    const FrontsView& view = qr.layout().view();
    std::vector<Terms> entries;
    std::vector<const double*> read;
    for (std::size_t b = 0; b < qr.blocks(); ++b) {
      entries.push_back(zeros(static_cast<std::size_t>(qr.entriesOf(b).size())));
      if (b < forces.effortBlocks()) {
        entries[b][0] = Term(qr.entriesOf(b)(0, 0));
      } else {
        setEntries(forces, unknowns, b - forces.effortBlocks(), entries[b]);
      }
    }
    for (const Terms& block : entries) read.push_back(numbersOf(block));
    Terms numbers = zeros(qr.layout().numbers()), condition = zeros(1);
    std::vector<FrontState> states(qr.layout().fronts().size());
    std::vector<int> stairs(qr.layout().stairs());
    const FrontsMemory memory{numbersOf(numbers), states.data(), stairs.data()};
    const Factorized done = TermFronts::factorize(view, read.data(), forces.largestSize(), memory,
                                                  numbersOf(condition));
    if (done != Factorized::kWhole || !judge(forces, condition[0])) return false;
    Terms load, x = zeros(qr.layout().rows());
    for (std::size_t row = 0; row < forces.group().coordinates.size(); ++row) {
      const auto coordinate = static_cast<std::size_t>(forces.group().coordinates[row]);
      load.push_back(sample_.effort[coordinate] / Term(forces.rowUnit(row)));
    }
    TermFronts::leastNorm(view, memory, numbersOf(load), numbersOf(x));
    if (!forces.effortsFollow() && !areUnique(forces, memory)) return false;
    collect(forces, unknowns, x);
    return true;
  }

  bool judge(const LoopForces& forces, const Term& condition) {
    if (!(graph().valueOf(condition) <= forces.sureCondition())) return false;
    graph().requireAtMost(condition, Term(forces.sureCondition()));
    close_ = close_ + graph().unlessAtMost(condition, Term(kCloseToSingular));
    if (model_.loops.policy == RedundancyPolicy::kMinimumNorm) return true;
    if (forces.factorization().nullity() == 0) return true;
    throw SceneError(
        "no code can be generated, as constraints are redundant: the choice that `redundancy` asks "
        "for depends on the position (minimum_norm does not)");
  }

  // Where the null space moves no effort, that of least norm is the only one.
  bool areUnique(const LoopForces& forces, const FrontsMemory& memory) {
    const FrontLayout& layout = forces.factorization().layout();
    for (const LoopUnknowns::Effort& effort : forces.efforts()) {
      const FrontLayout::RowPlace& place = layout.placeOf(static_cast<std::size_t>(effort.unknown));
      Terms square = zeros(1);
      TermFronts::nullSquare(layout.view(), memory, place.front, place.row, numbersOf(square));
      if (!LoopForces::isUnique(graph().valueOf(square[0]))) {
        if (!variants_.empty()) return false;
        throw SceneError("no code can be generated, as the effort of " +
                         inQuotes(model_.effortNames()[effort.index]) +
                         " is not determined: more actuators than degrees of freedom");
      }
      graph().requireAtMost(square[0], Term(LoopForces::kLargestUnique));
    }
    return true;
  }

  // See LoopForces::setClosures() and ClosedLoopDynamics::Workspace::Impl::collect().
  void collect(const LoopForces& forces, const LoopUnknowns& unknowns, const Terms& x) {
    for (const LoopUnknowns::Effort& effort : forces.efforts()) {
      effort_[effort.index] = Term(effort.unit) * x[static_cast<std::size_t>(effort.unknown)];
    }
    const LoopGroup& group = forces.group();
    for (std::size_t local = 0; local < group.sets.size(); ++local) {
      const LoopUnknowns::OfSet& own = unknowns.of_sets[local];
      const Term* const of_set = &x[static_cast<std::size_t>(own.first)];
      if (local >= group.closures.size()) {
        const std::size_t coupling = own.set - model_.scene.closures.size();
        effort_[model_.loops.actuated.size() + model_.loops.actuated_closures.size() + coupling] =
            Term(forces.unitsOf(local)[0]) * of_set[0];
        continue;
      }
      const std::size_t first = static_cast<std::size_t>(kinematics_.firstOf(own.set));
      Term* const sum = &closures_[kWrenchNumbers * own.set];
      sumWrenches<Term>(kinematics_.closure(own.set).shape(), forces.unitsOf(local),
                        reinterpret_cast<const double*>(of_set),
                        numbersOf(wrenches_) + kWrenchNumbers * first,
                        reinterpret_cast<double*>(sum));
      if (own.effort < 0) continue;
      const Term effort = of_set[own.multipliers()] * Term(own.columns.back().unit);
      Term* const active = sum + (kinematics_.closure(own.set).freeUnit() == Unit::kMetre ? 0 : 3);
      const TermVector axis = vectorAt(frame(own.set) + kFrameP + 6);
      putVector(active, vectorAt(active) + times(effort, axis));
    }
  }

  Terms reactions(const LoopReactions& of, const Terms& tree) const {
    Terms values = zeros(kWrenchNumbers * of.size());
    if (values.empty()) return values;
    findReactions<Term>(of.view(), {numbersOf(links_), numbersOf(frames_), numbersOf(closures_),
                                    numbersOf(tree), 1, numbersOf(values)});
    return values;
  }

  // The results of the first variant that does not fail; where all do, zero.
  void output() {
    Variant chosen = variants_.back();
    const auto choose = [&](const Variant& before, const Terms& own, Terms& of) {
      for (std::size_t i = 0; i < of.size(); ++i) {
        of[i] = wherePositive(before.failures, of[i], own[i]);
      }
    };
    for (std::size_t v = variants_.size() - 1; v-- > 0;) {
      const Variant& before = variants_[v];
      choose(before, before.effort, chosen.effort);
      choose(before, before.child_axes, chosen.child_axes);
      choose(before, before.root_axes, chosen.root_axes);
      chosen.doubts = wherePositive(before.failures, chosen.doubts, before.doubts);
      chosen.failures = wherePositive(before.failures, chosen.failures, before.failures);
    }
    Term largest(0);
    for (const Terms* of : {&chosen.effort, &chosen.child_axes, &chosen.root_axes}) {
      for (const Term& value : *of) largest = largest + absolute(value);
    }
    const Term failures =
        chosen.failures + graph().unlessAtMost(largest, Term(std::numeric_limits<double>::max()));
    const auto judged = [&](Terms terms) {
      for (Term& term : terms) term = wherePositive(failures, Term(0), term);
      return terms;
    };
    if (model_.dynamics.request().efforts) {
      addOutputs(recording_, {"effort", 0, "N m or N"}, judged(chosen.effort));
    }
    addReactions(recording_, judged(chosen.child_axes), judged(chosen.root_axes));
    addOutputs(recording_, {"status", 0, ""}, {wherePositive(failures, Term(2), chosen.doubts)});
  }

  /// What is computed where one set of requirements is met.
  struct Variant {
    Term failures, doubts;
    Terms effort, child_axes, root_axes;
  };

  const LoopModel& model_;
  const LoopKinematics& kinematics_;
  RecordedPlan& recording_;
  SampleTerms sample_;
  Terms links_, frames_, phi_, turning_, A_, wrenches_;
  Terms closures_;  // their wrenches
  Terms effort_;
  std::vector<Variant> variants_;
  Term close_{0};  // how many groups are close to a singular position
};

}  // namespace

RecordedPlan recordLoops(const LoopModel& model) {
  RecordedPlan recording;
  const GraphInUse in_use(recording.graph);
  LoopRecorder(model, recording).record();
  recording.judged = true;
  return recording;
}

}  // namespace virtual_work_dynamics
