#include "offline/npz_result_writer.h"

#include <cmath>
#include <limits>

#include "offline/mechanism_json.h"

namespace virtual_work_dynamics {
namespace {

std::vector<NpzColumn> npzColumns(const Columns& columns) {
  std::vector<NpzColumn> arrays;
  for (const std::string& name : resultColumns(columns)) arrays.push_back({name, false});
  if (columns.stamps) arrays[1].times = true;
  return arrays;
}

}  // namespace

NpzResultWriter::NpzResultWriter(OutputFile& file, const Columns& columns, std::size_t rows,
                                 const std::string& mechanism)
    : writer_(file, npzColumns(columns), rows, {{kMechanismFile, mechanism}}) {}

void NpzResultWriter::beginRow(double time) {
  writer_.add(time);
}

void NpzResultWriter::writeStamp(std::int64_t stamp_ns) {
  writer_.addTime(stamp_ns);
}

void NpzResultWriter::add(double value) {
  writer_.add(std::isfinite(value) ? value : std::numeric_limits<double>::quiet_NaN());
}

void NpzResultWriter::writeResults(const Eigen::VectorXd& effort,
                                   const std::vector<Wrench>& reactions,
                                   const std::vector<double>& more,
                                   const std::vector<double>& bounds) {
  for (Eigen::Index i = 0; i < effort.size(); ++i) add(effort[i]);
  for (const Wrench& wrench : reactions) {
    for (int i = 0; i < 3; ++i) add(wrench.force[i]);
    for (int i = 0; i < 3; ++i) add(wrench.torque[i]);
  }
  for (const double value : more) add(value);
  for (const double value : bounds) writer_.add(value);
}

void NpzResultWriter::finish() {
  writer_.finish();
}

}  // namespace virtual_work_dynamics
