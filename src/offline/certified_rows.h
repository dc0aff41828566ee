#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "offline/loop_sample.h"
#include "virtual_work_dynamics/certificates.h"

namespace virtual_work_dynamics {

/// Certifies the rows of a file and remembers the worst.
class CertifiedRows {
 public:
  /// @param request of the results, extended
  CertifiedRows(const Mechanism& mechanism, const Scene& scene, const Request& request)
      : certifier_(mechanism, scene), ground_(Certifier::groundIndex(request)) {}

  /// Of a Workspace, or of LagrangeDynamics.
  /// @param line of the row in its file   @param cells gets one for each of kCertificateColumns
  template <typename Results>
  void check(const Motion& motion, const Results& results, std::size_t line,
             std::vector<double>& cells) {
    const Certificates found =
        certifier_.check(motion, results.effort(), results.childAxes()[ground_]);
    note(found, line);
    cells.insert(cells.end(), {found.power, found.ground_force, found.ground_moment});
  }

  /// Of a mechanism with closed loops, of whose tree this was made. Singular positions, which
  /// need not bear the load, are not certified.
  template <typename Results>
  void check(const LoopSample& loops, const Results& results, std::size_t line,
             std::vector<double>& cells) {
    if (loops.singular()) {
      ++singular_;
      cells.insert(cells.end(), 3, std::numeric_limits<double>::quiet_NaN());
      return;
    }
    loops.applyTo(certifier_);
    const Motion& motion = loops.motion();
    const Certificates found = certifier_.check(motion, results.effort().head(motion.q.size()),
                                                results.childAxes()[ground_]);
    note(found, line);
    cells.insert(cells.end(), {found.power, found.ground_force, found.ground_moment});
  }

  /// One line on the worst of all rows.
  std::string summary() const;

 private:
  void note(const Certificates& found, std::size_t line);

  Certifier certifier_;
  std::size_t ground_;
  double worst_ = -1;  ///< no row yet
  const char* worst_column_ = "";
  std::size_t worst_line_ = 0;
  std::size_t uncertified_ = 0;  ///< rows whose certificates are not finite
  std::size_t singular_ = 0;     ///< rows
};

/// Names of the columns, in the order of the members of Certificates.
extern const char* const kCertificateColumns[3];

}  // namespace virtual_work_dynamics
