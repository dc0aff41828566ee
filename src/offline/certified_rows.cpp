#include "offline/certified_rows.h"

#include <cmath>
#include <limits>
#include <sstream>

namespace virtual_work_dynamics {

const char* const kCertificateColumns[3] = {"certificate.power", "certificate.ground_force",
                                            "certificate.ground_moment"};

void CertifiedRows::check(const Motion& motion, const Load& load, const Results& results,
                          std::size_t line, std::vector<double>& cells) {
  if (results.singular()) {
    ++singular_;
    cells.insert(cells.end(), 3, std::numeric_limits<double>::quiet_NaN());
    return;
  }
  dynamics_.getTreeLoad(results, load, load_);
  const Certificates found = certifier_.check(motion, load_, results.treeEffort(motion.q.size()),
                                              results.child_axes[ground_]);
  note(found, line);
  cells.insert(cells.end(), {found.power, found.ground_force, found.ground_moment});
}

void CertifiedRows::note(const Certificates& found, std::size_t line) {
  if (!std::isfinite(found.largest())) {
    ++uncertified_;
    return;
  }
  const double values[3] = {found.power, found.ground_force, found.ground_moment};
  for (int i = 0; i < 3; ++i) {
    if (values[i] <= worst_) continue;
    worst_ = values[i];
    worst_column_ = kCertificateColumns[i];
    worst_line_ = line;
  }
}

std::string CertifiedRows::summary(const char* row_name) const {
  std::ostringstream text;
  text.precision(2);
  if (worst_ >= 0) {
    text << worst_column_ << " is " << worst_ << " at worst, " << row_name << " " << worst_line_;
  }
  const auto addRows = [&](std::size_t rows, const char* why) {
    if (rows == 0) return;
    text << (text.str().empty() ? "" : "; ") << rows << (rows == 1 ? " row" : " rows")
         << " not certified: " << why;
  };
  addRows(uncertified_, "not finite");
  addRows(singular_, "singular positions");
  return text.str();
}

}  // namespace virtual_work_dynamics
