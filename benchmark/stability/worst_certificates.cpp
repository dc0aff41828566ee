#include "stability/worst_certificates.h"

#ifdef VWD_HAS_REAL113

#include <algorithm>
#include <cmath>
#include <limits>

namespace virtual_work_dynamics {
namespace {

// NaN would be lost in a maximum.
double larger(double a, double b) {
  return std::isfinite(b) ? std::max(a, b) : std::numeric_limits<double>::infinity();
}

bool areFinite(const std::vector<long double>& numbers) {
  return std::all_of(numbers.begin(), numbers.end(),
                     [](long double number) { return std::isfinite(number); });
}

Eigen::VectorXd effortsOf(const StateResults& results) {
  Eigen::VectorXd efforts(static_cast<Eigen::Index>(results.efforts.size()));
  for (Eigen::Index i = 0; i < efforts.size(); ++i) {
    efforts[i] = static_cast<double>(results.efforts[static_cast<std::size_t>(i)]);
  }
  return efforts;
}

Wrench groundOf(const StateResults& results) {
  Wrench ground;
  for (int i = 0; i < 3; ++i) {
    ground.force[i] = static_cast<double>(results.child_axes[static_cast<std::size_t>(i)]);
    ground.torque[i] = static_cast<double>(results.child_axes[static_cast<std::size_t>(i) + 3]);
  }
  return ground;
}

}  // namespace

void WorstCertificates::include(const Certificates& other) {
  worst.power = larger(worst.power, other.power);
  worst.ground_force = larger(worst.ground_force, other.ground_force);
  worst.ground_moment = larger(worst.ground_moment, other.ground_moment);
}

void WorstCertificates::include(const WorstCertificates& other) {
  include(other.worst);
  limit = std::max(limit, other.limit);
}

std::string WorstCertificates::worstName() const {
  const double largest = worst.largest();
  if (worst.power == largest) return "power";
  return worst.ground_force == largest ? "ground's force" : "ground's moment";
}

WorstCertificates certify(const Mechanism& mechanism, const Scene& scene,
                          const std::vector<Motion>& motions,
                          const std::vector<StateResults>& results) {
  Certifier certifier(mechanism, scene);
  WorstCertificates certificates;
  // Certificates are relative to the same sums of norms as the bounds of errors, and no effort has
  // more steps behind it than the wrench of ground.
  const ErrorBound bound(mechanism, scene);
  certificates.limit = 4 * bound.depths().front() * std::numeric_limits<double>::epsilon();
  for (std::size_t n = 0; n < motions.size(); ++n) {
    const StateResults& state = results[n];
    if (!areFinite(state.efforts) || !areFinite(state.child_axes)) continue;
    certificates.include(certifier.check(motions[n], effortsOf(state), groundOf(state)));
  }
  return certificates;
}

}  // namespace virtual_work_dynamics

#endif  // VWD_HAS_REAL113
