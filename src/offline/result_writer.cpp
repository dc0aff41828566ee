#include "offline/result_writer.h"

#include <cmath>

#include "base/printable.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr std::size_t kBytesAtOnce = 1 << 18;

const std::string& checkedName(const char* what, const std::string& name) {
  if (name.find_first_of(",\"\r\n") != std::string::npos) {
    throw FileError(std::string(what) + " " + inQuotes(name) +
                    ": a comma, quote or line end cannot stand in a CSV header");
  }
  return name;
}

}  // namespace

std::vector<std::string> resultColumns(const Columns& columns) {
  std::vector<std::string> names{"time"};
  if (columns.stamps) names.emplace_back("stamp");
  for (std::size_t i = 0; i < columns.efforts.size(); ++i) {
    names.push_back(columns.effortColumn(i));
  }
  for (const std::string& name : columns.reactions) {
    for (const char* component : kWrenchComponents) {
      names.push_back("reaction." + name + "." + component);
    }
  }
  names.insert(names.end(), columns.more.begin(), columns.more.end());
  names.insert(names.end(), columns.bounds.begin(), columns.bounds.end());
  return names;
}

std::string resultHeader(const Columns& columns) {
  for (const std::string& name : columns.efforts) checkedName("joint", name);
  for (const std::string& name : columns.reactions) checkedName("joint", name);
  for (const std::string& name : columns.more) checkedName("column", name);
  std::string header;
  for (const std::string& name : resultColumns(columns)) {
    header += (header.empty() ? "" : ",") + name;
  }
  return header + "\n";
}

void ResultWriter::appendCell(double value) {
  text_ += ',';
  if (std::isfinite(value)) appendNumber(text_, value);
}

void ResultWriter::writeStamp(std::int64_t stamp_ns) {
  text_ += ',';
  appendSeconds(text_, stamp_ns);
}

void ResultWriter::writeResults(const Eigen::VectorXd& effort, const std::vector<Wrench>& reactions,
                                const std::vector<double>& more,
                                const std::vector<double>& bounds) {
  for (Eigen::Index i = 0; i < effort.size(); ++i) appendCell(effort[i]);
  for (const Wrench& wrench : reactions) {
    for (int i = 0; i < 3; ++i) appendCell(wrench.force[i]);
    for (int i = 0; i < 3; ++i) appendCell(wrench.torque[i]);
  }
  for (const double value : more) appendCell(value);
  for (const double value : bounds) {
    if (std::isinf(value)) {
      text_ += value > 0 ? ",inf" : ",-inf";
    } else {
      appendCell(value);
    }
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
