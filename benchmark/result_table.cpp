#include "result_table.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>

namespace virtual_work_dynamics {
namespace {

__attribute__((format(printf, 1, 2))) std::string formatted(const char* format, ...) {
  char text[256];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof(text), format, arguments);
  va_end(arguments);
  return text;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

const ResultRow* rowOf(const std::vector<ResultRow>& rows, const std::string& method) {
  const auto row = std::find_if(rows.begin(), rows.end(),
                                [&](const ResultRow& r) { return r.label.method == method; });
  return row == rows.end() ? nullptr : &*row;
}

bool sameButOutputs(const Label& a, const Label& b) {
  return a.method == b.method && a.precision == b.precision && a.mode == b.mode &&
         a.threads == b.threads;
}

// Time and ratio of a method with the given outputs.
std::string cell(const std::vector<ResultRow>& rows, const Label& label, const char* outputs,
                 const ResultRow* yardstick) {
  for (const ResultRow& row : rows) {
    if (!sameButOutputs(row.label, label)) continue;
    // A completed motion has a line of its own, and stands where efforts do.
    const bool motion = row.label.outputs == kCompletedMotion && outputs == kEfforts;
    if (row.label.outputs != outputs && !motion) continue;
    const std::string ratio = yardstick == nullptr ? "" : formatted("%.2f", yardstick->ns / row.ns);
    return formatted("%11.1f %7s  %7.1e", row.ns, ratio.c_str(), row.max_relative_error);
  }
  return formatted("%11s %7s  %7s", "", "", "");
}

}  // namespace

ResultRow resultRow(const std::string& scene, const Candidate& candidate) {
  const std::vector<double>& times = candidate.ns_per_sample;
  const auto ends = std::minmax_element(times.begin(), times.end());
  return {scene,       candidate.label, median(times),
          *ends.first, *ends.second,    candidate.max_relative_error};
}

std::string resultCsv(const std::vector<ResultRow>& rows) {
  std::string text =
      "scene,method,precision,mode,outputs,threads,ns_per_sample,ns_min,ns_max,"
      "max_relative_error\n";
  for (const ResultRow& row : rows) {
    const Label& label = row.label;
    text += row.scene + ',' + label.method + ',' + label.precision + ',' + label.mode + ',' +
            label.outputs +
            formatted(",%d,%.6g,%.6g,%.6g,%.3g\n", label.threads, row.ns, row.ns_min, row.ns_max,
                      row.max_relative_error);
  }
  return text;
}

std::string resultTable(const std::string& scene, const std::vector<ResultRow>& rows) {
  const ResultRow* yardstick = rowOf(rows, "kdl_chain");
  if (yardstick == nullptr) yardstick = rowOf(rows, "kdl_tree");
  const std::string ratio =
      yardstick == nullptr ? "" : "x: times faster than " + yardstick->label.method;
  std::string text =
      formatted("\n%-60s %29s %29s\n", scene.c_str(), "efforts", "efforts and reactions") +
      formatted("%-60s %11s %7s  %7s %11s %7s  %7s\n", ratio.c_str(), "ns/sample", "x", "error",
                "ns/sample", "x", "error");
  for (auto row = rows.begin(); row != rows.end(); ++row) {
    const Label& label = row->label;
    const auto shown = [&](const ResultRow& other) { return sameButOutputs(other.label, label); };
    if (std::any_of(rows.begin(), row, shown)) continue;
    text +=
        formatted("%-16s %-11s %-20s %d thread%-2s", label.method.c_str(), label.precision.c_str(),
                  label.mode.c_str(), label.threads, label.threads == 1 ? "" : "s") +
        ' ' + cell(rows, label, kEfforts, yardstick) + ' ' +
        cell(rows, label, kEffortsAndReactions, yardstick) + '\n';
  }
  return text;
}

}  // namespace virtual_work_dynamics
