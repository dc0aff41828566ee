#include "offline/regressor_files.h"

#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <limits>
#include <system_error>
#include <utility>

#include "base/json_text.h"
#include "base/number_text.h"
#include "base/output_file.h"
#include "base/printable.h"
#include "npz/npy_header.h"
#include "offline/computation.h"
#include "offline/progress.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr std::size_t kRowsOfABlock = 512;
// As it lies in memory.
const char* const kDouble = __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? "<f8" : ">f8";

void writeNumbers(OutputFile& file, const double* numbers, std::size_t count) {
  std::string bytes(count * sizeof(double), '\0');
  if (count > 0) std::memcpy(bytes.data(), numbers, bytes.size());
  file.write(bytes);
}

// Row after row, as the file has them.
void writeMatrix(const std::string& path, const Eigen::MatrixXd& matrix) {
  OutputFile file(path);
  file.write(npyHeader(
      kDouble, {static_cast<std::size_t>(matrix.rows()), static_cast<std::size_t>(matrix.cols())}));
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    const Eigen::VectorXd numbers = matrix.row(row);
    writeNumbers(file, numbers.data(), static_cast<std::size_t>(numbers.size()));
  }
  file.commit();
}

// Efforts, not a number where they have no value.
Eigen::VectorXd existing(const Results& results) {
  Eigen::VectorXd effort = results.effort;
  for (Eigen::Index i = 0; i < effort.size(); ++i) {
    if (!results.effortExists(static_cast<std::size_t>(i))) {
      effort[i] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  return effort;
}

std::string listOf(const std::vector<std::string>& texts) {
  std::string list;
  for (const std::string& text : texts) list += (list.empty() ? "" : ", ") + jsonText(text);
  return "[" + list + "]";
}

}  // namespace

std::vector<Parameter> askedParameters(const Mechanism& mechanism, const Scene& scene,
                                       const std::vector<std::string>& asked) {
  std::vector<Parameter> parameters;
  const auto add = [&](const std::vector<Parameter>& more) {
    parameters.insert(parameters.end(), more.begin(), more.end());
  };
  for (const std::string& word : asked) {
    if (word == "joints") {
      add(jointParameters(mechanism, scene));
    } else if (word == "links") {
      for (const std::string& link : bodies(mechanism)) add(inertialParameters(mechanism, link));
    } else {
      add(inertialParameters(mechanism, word));
    }
  }
  return parameters;
}

RegressorFiles::RegressorFiles(std::string folder, const Mechanism& mechanism, const Scene& scene,
                               int threads)
    : folder_(std::move(folder)), mechanism_(mechanism), scene_(scene), threads_(threads) {
  std::error_code problem;
  std::filesystem::create_directories(folder_, problem);
  if (problem) throw FileError(folder_ + ": cannot be made: " + problem.message());
  // Its presence says that the folder is complete.
  std::filesystem::remove(path("names.json"), problem);
}

void RegressorFiles::write(const Dynamics& dynamics, CompletedMotion& motion, const RowLoads& loads,
                           const std::vector<Parameter>& parameters) const {
  writeEfforts(dynamics, motion, loads);
  const MotionTable& table = motion.file().table;
  writeMotion(table);
  writeRegressor(table, parameters);
  writeNames(dynamics, parameters);
}

void RegressorFiles::writeEfforts(const Dynamics& dynamics, CompletedMotion& motion,
                                  const RowLoads& loads) const {
  const std::size_t rows = motion.file().lines.size();
  OutputFile file(path("effort.npy"));
  file.write(npyHeader(kDouble, {rows, dynamics.effortNames().size()}));
  std::size_t singular = 0, first = 0;
  Progress progress(std::cerr, ProgressLine::whereIs(STDERR_FILENO), "computing");
  Computation(dynamics, motion, loads, threads_)
      .run([&](std::size_t row, const Motion&, const Load&, const Results& results) {
        if (results.singular() && ++singular == 1) first = row;
        const Eigen::VectorXd effort = existing(results);
        writeNumbers(file, effort.data(), static_cast<std::size_t>(effort.size()));
        progress.update(row + 1, rows);
      });
  file.commit();
  if (singular == 0) return;
  std::cerr << "warning: " << printable(motion.file().path) << ": " << singular
            << (singular == 1 ? " row" : " rows") << " in singular positions, first in "
            << motion.file().place(first)
            << "; efforts without a value there, and all that they depend on, are nan\n";
}

void RegressorFiles::writeMotion(const MotionTable& table) const {
  writeMatrix(path("time.npy"),
              Eigen::Map<const Eigen::VectorXd>(table.times.data(),
                                                static_cast<Eigen::Index>(table.times.size())));
  writeMatrix(path("position.npy"), table.positions);
  writeMatrix(path("velocity.npy"), table.velocities);
  writeMatrix(path("acceleration.npy"), table.accelerations);
}

void RegressorFiles::writeRegressor(const MotionTable& table,
                                    const std::vector<Parameter>& parameters) const {
  const std::size_t rows = table.times.size();
  const std::size_t block = std::min(rows, kRowsOfABlock);
  OutputFile file(path("regressor.npy"));
  Progress progress(std::cerr, ProgressLine::whereIs(STDERR_FILENO), "regressor");
  std::vector<double> numbers;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    RegressorColumn column(mechanism_, scene_, parameters[i], block, threads_);
    const auto width = static_cast<std::size_t>(column.efforts());
    if (i == 0) file.write(npyHeader(kDouble, {parameters.size(), rows, width}));
    numbers.resize(block * width);
    for (std::size_t row = 0; row < rows; row += block) {
      const std::size_t count = std::min(block, rows - row);
      column.compute(table, row, count, numbers.data());
      writeNumbers(file, numbers.data(), count * width);
    }
    progress.update(i + 1, parameters.size());
  }
  file.commit();
}

void RegressorFiles::writeNames(const Dynamics& dynamics,
                                const std::vector<Parameter>& parameters) const {
  std::string list;
  for (const Parameter& parameter : parameters) {
    list += (list.empty() ? "" : ",") + std::string("\n  {\"kind\": ") +
            jsonText(nameOf(parameter.kind)) + ", \"of\": " + jsonText(parameter.of) +
            ", \"value\": ";
    appendNumber(list, parameter.value);
    list += "}";
  }
  std::vector<std::string> units;
  for (std::size_t i = 0; i < mechanism_.coordinates().size(); ++i) {
    units.emplace_back(symbolOf(mechanism_.unitOf(static_cast<int>(i))));
  }
  OutputFile file(path("names.json"));
  file.write("{\"efforts\": " + listOf(dynamics.effortNames()) +
             ",\n\"coordinates\": " + listOf(mechanism_.coordinateNames()) +
             ",\n\"units\": " + listOf(units) + ",\n\"bodies\": " + listOf(bodies(mechanism_)) +
             ",\n\"parameters\": [" + list + "]}\n");
  file.commit();
}

}  // namespace virtual_work_dynamics
