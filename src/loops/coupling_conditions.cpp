#include "loops/coupling_conditions.h"

#include <cmath>
#include <limits>
#include <memory>

#include "base/printable.h"

namespace virtual_work_dynamics {

namespace {

// Roundings of a sum, of its terms: what is left of terms that cancel to that is nothing, however
// many turns a motor has made.
constexpr double kSumRounding = 4 * std::numeric_limits<double>::epsilon();

std::vector<Condition> rowOf(const ResolvedCoupling& coupling) {
  Condition row;
  row.name = coupling.name;
  row.unit = coupling.unit;
  row.has_position = !coupling.rate_only;
  row.adopts_constant = coupling.adopts_offset;
  return {row};
}

std::vector<int> coordinatesOf(const ResolvedCoupling& coupling) {
  std::vector<int> coordinates;
  for (const ResolvedCoupling::Term& term : coupling.terms) coordinates.push_back(term.coordinate);
  return coordinates;
}

}  // namespace

CouplingCondition::CouplingCondition(const ResolvedCoupling& coupling)
    : ConditionSet("couplings: " + inQuotes(coupling.name), rowOf(coupling),
                   coordinatesOf(coupling)),
      coupling_(coupling) {}

void CouplingCondition::setPosition(const LoopState& state, ConditionRows rows) const {
  double sum = coupling_.adopts_offset ? 0 : -coupling_.offset;
  double size = std::abs(sum);
  for (const ResolvedCoupling::Term& term : coupling_.terms) {
    const double part = term.factor * state.q[term.coordinate];
    sum += part;
    size += std::abs(part);
    rows.A(0, term.coordinate) = term.factor;  // (3.2)
  }
  rows.rounding(0) = kSumRounding * size;
  const bool is_rounding = std::abs(sum) <= rows.rounding(0) && !coupling_.adopts_offset;
  rows.phi(0) = coupling_.rate_only || is_rounding ? 0 : sum;  // (3.3)
}

ConditionSets couplingConditions(const Mechanism& mechanism, const Scene& scene) {
  ConditionSets sets;
  for (const ResolvedCoupling& coupling : resolveCouplings(mechanism, scene)) {
    sets.push_back(std::make_shared<CouplingCondition>(coupling));
  }
  return sets;
}

}  // namespace virtual_work_dynamics
