#include "scene/couplings.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <sstream>

#include "base/number_text.h"
#include "base/printable.h"
#include "scene/lookup.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

// What is left of factors or offsets that cancel, relative to what they were.
constexpr long double kCancelled = 1e-12L;

std::string placeOf(const Coupling& coupling) {
  return "couplings: " + inQuotes(coupling.name);
}

std::string amountText(long double amount, Unit unit) {
  std::ostringstream text;  // six digits: the last ones of a difference are rounding
  text << static_cast<double>(std::abs(amount)) << " " << symbolOf(unit);
  return text.str();
}

void checkNames(const Mechanism& mechanism, const Scene& scene) {
  std::set<std::string> seen;
  for (const Coupling& coupling : scene.couplings) {
    const std::string& name = coupling.name;
    if (name.empty()) throw SceneError("couplings: a coupling has no name");
    if (name == kGround) throw SceneError(placeOf(coupling) + ": that name is reserved");
    if (mechanism.jointIndex(name) >= 0 || mechanism.reactionIndex(name) >= 0) {
      throw SceneError(placeOf(coupling) + ": a joint has the same name");
    }
    const auto isIt = [&](const Closure& closure) { return closure.name == name; };
    if (std::any_of(scene.closures.begin(), scene.closures.end(), isIt)) {
      throw SceneError(placeOf(coupling) + ": a closure has the same name");
    }
    if (!seen.insert(name).second) {
      throw SceneError("couplings: " + inQuotes(name) + " is given twice");
    }
  }
}

// Closures that couplings name have become joints.
void checkAxes(const Mechanism& mechanism, const Scene& scene) {
  if (scene.couplings.empty()) return;
  std::set<std::string> closures;
  for (const Closure& closure : scene.closures) closures.insert(closure.name);
  for (const Coupling& coupling : scene.couplings) {
    for (const NamedNumber& term : coupling.terms) {
      if (closures.count(term.name) == 0 || mechanism.jointIndex(term.name) >= 0) continue;
      throw SceneError(placeOf(coupling) + ": " + inQuotes(term.name) +
                       " is a closure, withClosureAxes() makes its free axis a coordinate");
    }
  }
}

// The angles of a joint that turns freely are those of a sample, and no lasting ones.
bool turnsFreely(const Mechanism& mechanism, int joint) {
  const CompoundJoint* const compound = mechanism.compoundOf(joint);
  return compound && compound->turnsFreely() && joint > compound->last - 3;
}

// A sum of coordinates that is to be `offset`.
struct Sum {
  std::map<int, long double> factors;  // by coordinate
  std::map<int, long double> sizes;    // of the largest factor that went into each
  long double offset = 0, mimicked = 0;
  long double offset_size = 0;  // of the largest offset
};

// Replaces mimic joints by what they mimic.
Sum sumOf(const Mechanism& mechanism, const Coupling& coupling, std::size_t index) {
  const std::string place = placeOf(coupling);
  Sum sum;
  sum.offset = coupling.offset.value_or(0);
  sum.offset_size = std::abs(sum.offset);
  std::set<std::string> seen;
  for (std::size_t i = 0; i < coupling.terms.size(); ++i) {
    const NamedNumber& term = coupling.terms[i];
    const int k = jointNamed(mechanism, term.name,
                             entryOf(entryOf("couplings", index) + ".terms", i) + ".name");
    const Joint& joint = mechanism.joint(k);
    if (!seen.insert(term.name).second) {
      throw SceneError(place + ": " + inQuotes(term.name) + " is given twice");
    }
    if (joint.coordinate < 0) {
      throw SceneError(place + ": " + inQuotes(term.name) + " is a fixed joint");
    }
    if (turnsFreely(mechanism, k)) {
      throw SceneError(place + ": " + inQuotes(term.name) +
                       " turns freely, so that it has no angle that lasts");
    }
    if (!std::isfinite(term.value) || term.value == 0) {
      throw SceneError(place + ": " + inQuotes(term.name) + ": factor = " + numberText(term.value) +
                       " is zero or not finite");
    }
    const long double factor = static_cast<long double>(term.value) * joint.multiplier;
    const long double offset = static_cast<long double>(term.value) * joint.offset;
    sum.factors[joint.coordinate] += factor;
    sum.mimicked += offset;
    long double& size = sum.sizes[joint.coordinate];
    size = std::max(size, std::abs(factor));
    sum.offset_size = std::max(sum.offset_size, std::abs(offset));
  }
  sum.offset -= sum.mimicked;
  return sum;
}

// Factors of different units differ in size as much as they like.
void dropCancelled(Sum& sum) {
  for (auto it = sum.factors.begin(); it != sum.factors.end();) {
    it = std::abs(it->second) <= kCancelled * sum.sizes[it->first] ? sum.factors.erase(it)
                                                                   : std::next(it);
  }
}

ResolvedCoupling resolve(const Mechanism& mechanism, const Coupling& coupling, std::size_t index) {
  const std::string place = placeOf(coupling);
  if (coupling.terms.empty()) throw SceneError(place + ": it has no terms");
  if (coupling.offset && !std::isfinite(*coupling.offset)) {
    throw SceneError(place + ": the offset is not finite");
  }
  if (coupling.offset && coupling.rate_only) {
    throw SceneError(place + ": rate_only: what ties velocities alone has no offset");
  }
  Sum sum = sumOf(mechanism, coupling, index);
  dropCancelled(sum);
  ResolvedCoupling resolved;
  resolved.name = coupling.name;
  resolved.unit = unitOf(mechanism.joint(mechanism.jointIndex(coupling.terms[0].name)));
  resolved.rate_only = coupling.rate_only;
  resolved.adopts_offset = !coupling.rate_only && !coupling.offset;
  resolved.offset = static_cast<double>(sum.offset);
  resolved.mimicked = static_cast<double>(sum.mimicked);
  if (sum.factors.empty()) {
    const bool contradicts = coupling.offset && std::abs(sum.offset) > kCancelled * sum.offset_size;
    throw SceneError(place + (contradicts
                                  ? ": it contradicts the mimic joints of the description by " +
                                        amountText(sum.offset, resolved.unit)
                                  : ": mimic joints of the description say the same "
                                    "already; leave it out"));
  }
  for (const auto& [coordinate, factor] : sum.factors) {
    resolved.terms.push_back({coordinate, static_cast<double>(factor)});
  }
  return resolved;
}

// Gaussian elimination of couplings that say their offsets, in their order.
class Elimination {
 public:
  // Takes a coupling into account. @throws SceneError when those before demand another offset.
  void add(const std::vector<ResolvedCoupling>& all, std::size_t index) {
    const ResolvedCoupling& coupling = all[index];
    Row row;
    row.offset = coupling.offset;
    row.parts[index] = 1;
    for (const ResolvedCoupling::Term& term : coupling.terms) {
      row.factors[term.coordinate] = term.factor;
      row.size = std::max(row.size, std::abs(static_cast<long double>(term.factor)));
    }
    row.offset_size = std::abs(row.offset);
    for (const Row& before : rows_) eliminate(before, row);
    long double largest = 0;
    for (const auto& [coordinate, factor] : row.factors) {
      if (std::abs(factor) <= largest) continue;
      largest = std::abs(factor);
      row.pivot = coordinate;
    }
    if (largest > kCancelled * row.size) {
      rows_.push_back(row);
    } else if (std::abs(row.offset) > kCancelled * row.offset_size) {
      refuse(all, index, row);
    }
  }

 private:
  struct Row {
    std::map<int, long double> factors;        // by coordinate
    std::map<std::size_t, long double> parts;  // of couplings
    long double offset = 0, size = 0, offset_size = 0;
    int pivot = 0;
  };

  static void eliminate(const Row& before, Row& row) {
    const auto found = row.factors.find(before.pivot);
    if (found == row.factors.end()) return;
    const long double share = found->second / before.factors.at(before.pivot);
    for (const auto& [coordinate, factor] : before.factors) {
      row.factors[coordinate] -= share * factor;
    }
    row.factors.erase(before.pivot);
    for (const auto& [part, factor] : before.parts) row.parts[part] -= share * factor;
    row.offset -= share * before.offset;
    row.size = std::max(row.size, std::abs(share) * before.size);
    row.offset_size = std::max(row.offset_size, std::abs(share) * before.offset_size);
  }

  [[noreturn]] static void refuse(const std::vector<ResolvedCoupling>& all, std::size_t index,
                                  const Row& row) {
    std::vector<std::string> others;
    for (const auto& [part, factor] : row.parts) {
      if (part != index && std::abs(factor) > kCancelled) others.push_back(all[part].name);
    }
    throw SceneError("couplings: " + inQuotes(all[index].name) + " contradicts " +
                     namesInQuotes(others) + " by " + amountText(row.offset, all[index].unit));
  }

  std::vector<Row> rows_;
};

}  // namespace

std::vector<ResolvedCoupling> resolveCouplings(const Mechanism& mechanism, const Scene& scene) {
  checkNames(mechanism, scene);
  checkAxes(mechanism, scene);
  std::vector<ResolvedCoupling> resolved;
  Elimination elimination;
  for (std::size_t i = 0; i < scene.couplings.size(); ++i) {
    resolved.push_back(resolve(mechanism, scene.couplings[i], i));
    if (scene.couplings[i].offset) elimination.add(resolved, i);
  }
  return resolved;
}

}  // namespace virtual_work_dynamics
