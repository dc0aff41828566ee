#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "virtual_work_dynamics/certificates.h"
#include "virtual_work_dynamics/dynamics.h"

namespace virtual_work_dynamics {

/// Certifies the rows of a file and remembers the worst.
class CertifiedRows {
 public:
  /// @param dynamics of a request from Certifier::extended(); must outlive it
  CertifiedRows(const Mechanism& mechanism, const Dynamics& dynamics)
      : dynamics_(dynamics),
        certifier_(mechanism, dynamics.tree()),
        ground_(Certifier::groundIndex(dynamics.request())) {}

  /// Certifies a row, unless its position is singular and so need not bear the load.
  /// @param load with which `results` were computed
  /// @param line of the row, see MotionFile
  /// @param cells receives one for each of kCertificateColumns
  void check(const Motion& motion, const Load& load, const Results& results, std::size_t line,
             std::vector<double>& cells);

  /// One line on the worst of all rows.
  /// @param row_name what lines count, see MotionFile
  std::string summary(const char* row_name) const;

 private:
  void note(const Certificates& found, std::size_t line);

  const Dynamics& dynamics_;
  Certifier certifier_;
  std::size_t ground_;
  Load load_;          // of the tree
  double worst_ = -1;  ///< negative before the first row
  const char* worst_column_ = "";
  std::size_t worst_line_ = 0;
  std::size_t uncertified_ = 0;  ///< rows with certificates that are not finite
  std::size_t singular_ = 0;     ///< rows
};

/// Names of the columns, in the order of the members of Certificates.
extern const char* const kCertificateColumns[3];

}  // namespace virtual_work_dynamics
