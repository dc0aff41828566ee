#include "virtual_work_dynamics/regressor.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "base/printable.h"
#include "dynamics/sample_rows.h"
#include "scene/bare_scene.h"
#include "scene/lookup.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr char kPlace[] = "parameters";

// The mechanism in which one link, or none, has mass or inertia.
Mechanism withOnly(const Mechanism& mechanism, const std::optional<Link>& alone, int index) {
  std::vector<Link> links = mechanism.links();
  for (Link& link : links) {
    link.mass = 0;
    link.p_KoCm_K.setZero();
    link.inertia_Cm_K.setZero();
  }
  if (alone) links[static_cast<std::size_t>(index)] = *alone;
  return Mechanism(mechanism.name(), std::move(links), mechanism.joints(), {},
                   mechanism.compounds());
}

// A link that is a mass at a point.
Link massAt(Link link, long double mass, const Vector3l& at) {
  link.mass = mass;
  link.p_KoCm_K = at;
  link.inertia_Cm_K.setZero();
  return link;
}

Link inertiaAlone(Link link, int row, int column) {
  link = massAt(std::move(link), 0, Vector3l::Zero());
  link.inertia_Cm_K(row, column) = link.inertia_Cm_K(column, row) = 1;
  return link;
}

struct WeightedLink {
  long double weight;
  Link link;
};

// Links whose efforts, weighted, are those of one parameter. A first moment without a mass is half
// the difference of two masses on both sides, in which mass and moments of inertia cancel.
std::vector<WeightedLink> linksOf(const Link& link, ParameterKind kind) {
  const auto moment = [&](int axis) -> std::vector<WeightedLink> {
    const Vector3l at = Vector3l::Unit(axis);
    return {{0.5L, massAt(link, 1, at)}, {-0.5L, massAt(link, 1, -at)}};
  };
  switch (kind) {
    case ParameterKind::kMass:
      return {{1, massAt(link, 1, Vector3l::Zero())}};
    case ParameterKind::kFirstMomentX:
      return moment(0);
    case ParameterKind::kFirstMomentY:
      return moment(1);
    case ParameterKind::kFirstMomentZ:
      return moment(2);
    case ParameterKind::kInertiaXX:
      return {{1, inertiaAlone(link, 0, 0)}};
    case ParameterKind::kInertiaXY:
      return {{1, inertiaAlone(link, 0, 1)}};
    case ParameterKind::kInertiaXZ:
      return {{1, inertiaAlone(link, 0, 2)}};
    case ParameterKind::kInertiaYY:
      return {{1, inertiaAlone(link, 1, 1)}};
    case ParameterKind::kInertiaYZ:
      return {{1, inertiaAlone(link, 1, 2)}};
    case ParameterKind::kInertiaZZ:
      return {{1, inertiaAlone(link, 2, 2)}};
    default:
      return {};
  }
}

bool isOfJoint(ParameterKind kind) {
  return kind == ParameterKind::kDamping || kind == ParameterKind::kCoulomb ||
         kind == ParameterKind::kRotorInertia || kind == ParameterKind::kOffset;
}

// The term of a joint that is one, with the scene's velocity of dry friction.
JointTerms unitTerm(const Scene& scene, const Parameter& parameter) {
  JointTerms terms;
  terms.joint = parameter.of;
  for (const JointTerms& given : scene.joints) {
    if (given.joint == parameter.of) terms.coulomb_velocity = given.coulomb_velocity;
  }
  if (parameter.kind == ParameterKind::kDamping) terms.damping = 1;
  if (parameter.kind == ParameterKind::kCoulomb) terms.coulomb = 1;
  if (parameter.kind == ParameterKind::kRotorInertia) terms.rotor_inertia = 1;
  if (parameter.kind == ParameterKind::kOffset) terms.offset = 1;
  return terms;
}

Request effortsAlone() {
  Request request;
  request.determinacy = request.residuals = false;
  return request;
}

}  // namespace

struct RegressorColumn::Part {
  Part(const Mechanism& mechanism, const Scene& scene, double its_weight, std::size_t capacity,
       int threads)
      : dynamics(mechanism, scene, effortsAlone()),
        samples(dynamics, capacity, threads),
        weight(its_weight) {}

  Dynamics dynamics;
  SampleRows samples;
  double weight;
};

RegressorColumn::RegressorColumn(const Mechanism& mechanism, const Scene& scene,
                                 const Parameter& parameter, std::size_t capacity, int threads) {
  Scene bare = bareScene(scene);
  if (isOfJoint(parameter.kind)) {
    jointNamed(mechanism, parameter.of, kPlace);
    bare.joints = {unitTerm(scene, parameter)};
    parts_.push_back(
        std::make_unique<Part>(withOnly(mechanism, std::nullopt, 0), bare, 1, capacity, threads));
    return;
  }
  const int index = linkNamed(mechanism, parameter.of, kPlace);
  for (const auto& [weight, link] : linksOf(mechanism.link(index), parameter.kind)) {
    parts_.push_back(std::make_unique<Part>(withOnly(mechanism, link, index), bare,
                                            static_cast<double>(weight), capacity, threads));
  }
}

RegressorColumn::~RegressorColumn() = default;
RegressorColumn::RegressorColumn(RegressorColumn&&) noexcept = default;
RegressorColumn& RegressorColumn::operator=(RegressorColumn&&) noexcept = default;

Eigen::Index RegressorColumn::efforts() const {
  return static_cast<Eigen::Index>(parts_.front()->dynamics.effortNames().size());
}

void RegressorColumn::compute(const MotionTable& table, std::size_t first, std::size_t count,
                              double* to) {
  const Eigen::Index width = efforts();
  for (const auto& part : parts_) part->samples.compute(table, first, count);
  for (std::size_t row = 0; row < count; ++row, to += width) {
    Eigen::Map<Eigen::VectorXd> sum(to, width);
    sum.setZero();
    for (const auto& part : parts_) {
      const Results& results = part->samples.read(row);
      sum += part->weight * results.effort;
      for (Eigen::Index i = 0; i < width; ++i) {
        if (!results.effortExists(static_cast<std::size_t>(i))) {
          sum[i] = std::numeric_limits<double>::quiet_NaN();
        }
      }
    }
  }
}

}  // namespace virtual_work_dynamics
