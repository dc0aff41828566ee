#include "offline/result_writer.h"

#include <cmath>

#include "offline/certified_rows.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/number_text.h"

namespace virtual_work_dynamics {
namespace {

constexpr std::size_t kBytesAtOnce = 1 << 18;

const std::string& checkedName(const std::string& name) {
  if (name.find_first_of(",\"\r\n") != std::string::npos) {
    throw FileError("joint '" + name +
                    "': a comma, quote or line end cannot stand in a CSV header");
  }
  return name;
}

}  // namespace

std::string resultHeader(const std::vector<std::string>& coordinates,
                         const std::vector<std::string>& reactions, bool certificates) {
  std::string header = "time";
  for (const std::string& name : coordinates) header += ",effort." + checkedName(name);
  for (const std::string& name : reactions) {
    for (const char* component : {"fx", "fy", "fz", "tx", "ty", "tz"}) {
      header += ",reaction." + checkedName(name) + "." + component;
    }
  }
  if (certificates) {
    for (const char* column : kCertificateColumns) header += std::string(",") + column;
  }
  return header + "\n";
}

void ResultWriter::appendCell(double value) {
  text_ += ',';
  if (std::isfinite(value)) appendNumber(text_, value);
}

void ResultWriter::writeRow(double time, const Eigen::VectorXd& effort,
                            const std::vector<Wrench>& reactions,
                            const Certificates* certificates) {
  appendNumber(text_, time);
  for (Eigen::Index i = 0; i < effort.size(); ++i) appendCell(effort[i]);
  for (const Wrench& wrench : reactions) {
    for (int i = 0; i < 3; ++i) appendCell(wrench.force[i]);
    for (int i = 0; i < 3; ++i) appendCell(wrench.torque[i]);
  }
  if (certificates) {
    appendCell(certificates->power);
    appendCell(certificates->ground_force);
    appendCell(certificates->ground_moment);
  }
  text_ += '\n';
  if (text_.size() < kBytesAtOnce) return;
  file_.write(text_);
  text_.clear();
}

void ResultWriter::finish() {
  file_.write(text_);
  text_.clear();
  file_.commit();
}

}  // namespace virtual_work_dynamics
