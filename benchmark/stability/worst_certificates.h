#pragma once

#include <string>
#include <vector>

#include "stability/exact_results.h"
#include "virtual_work_dynamics/certificates.h"

namespace virtual_work_dynamics {

#ifdef VWD_HAS_REAL113

/// The worst certificates of some states of one mechanism; a certificate that is not finite counts
/// as infinite.
struct WorstCertificates {
  Certificates worst;
  double limit = 0;  ///< limit of each: 4 L eps, L the depth of the wrench of ground, eps 2^-52

  void include(const Certificates& other);
  void include(const WorstCertificates& other);
  double overLimit() const { return worst.largest() / limit; }
  /// Name of the worst certificate: "power", "ground's force" or "ground's moment".
  std::string worstName() const;
};

/// Certifies results of double. States whose results are not finite are left out: they are beyond
/// their bounds already.
/// @param results the results of `motions`, with the reaction of ground first in child axes.
WorstCertificates certify(const Mechanism& mechanism, const Scene& scene,
                          const std::vector<Motion>& motions,
                          const std::vector<StateResults>& results);

#endif  // VWD_HAS_REAL113

}  // namespace virtual_work_dynamics
