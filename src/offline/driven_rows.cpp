#include "offline/driven_rows.h"

#include <algorithm>
#include <cmath>
#include <iostream>

#include "base/number_text.h"
#include "base/printable.h"
#include "scene/closure_types.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

using Names = std::vector<std::string>;

constexpr double kTurn = 6.283185307179586476925286766559;

// The matrices of a table that are given.
std::vector<Eigen::MatrixXd*> levelsOf(MotionTable& table) {
  std::vector<Eigen::MatrixXd*> levels{&table.positions};
  if (table.hasVelocities()) levels.push_back(&table.velocities);
  if (table.hasAccelerations()) levels.push_back(&table.accelerations);
  return levels;
}

// Takes a column off a table, with its positions.
Eigen::VectorXd takenColumn(std::size_t index, MotionTable& table) {
  const auto column = static_cast<Eigen::Index>(index);
  const Eigen::VectorXd positions = table.positions.col(column);
  for (Eigen::MatrixXd* level : levelsOf(table)) {
    const Eigen::Index after = level->cols() - column - 1;
    level->middleCols(column, after) = level->rightCols(after).eval();
    level->conservativeResize(Eigen::NoChange, column + after);
  }
  table.joints.erase(table.joints.begin() + static_cast<std::ptrdiff_t>(index));
  return positions;
}

// Says by how much positions of a file are not those of the drive.
void noteDifference(const std::string& name, Unit unit, const Eigen::VectorXd& found,
                    const Eigen::VectorXd& driven, const MotionFile& file) {
  double worst = 0;
  std::size_t row = 0;
  for (Eigen::Index i = 0; i < found.size(); ++i) {
    const double off = found[i] - driven[i];
    const double amount = std::abs(unit == Unit::kRadian ? std::remainder(off, kTurn) : off);
    if (amount <= worst) continue;
    worst = amount;
    row = static_cast<std::size_t>(i);
  }
  std::cerr << "note: " << printable(file.path) << ": the motion of " << inQuotes(name)
            << " is not used, as it has a drive";
  if (worst > 0) {
    std::cerr << "; its positions differ by up to " << numberText(worst) << " " << symbolOf(unit)
              << ", " << file.place(row);
  }
  std::cerr << "\n";
}

}  // namespace

DrivenRows::DrivenRows(const Mechanism& mechanism, const Scene& scene, const Given& given,
                       bool degrees, std::int64_t start_ns, MotionFile& file) {
  if (scene.drives.empty()) return;
  Drives drives(mechanism, scene);
  std::vector<Unit> units;
  for (std::size_t i = 0; i < drives.coordinates().size(); ++i) {
    if (!drives.coordinates()[i]) continue;
    coordinates_.push_back(static_cast<Eigen::Index>(i));
    columns_.joints.push_back(mechanism.coordinateNames()[i]);
    units.push_back(mechanism.unitOf(static_cast<int>(i)));
  }
  closures_ = drives.closures().size();
  for (const std::size_t c : drives.closures()) {
    columns_.joints.push_back(scene.closures[c].name);
    units.push_back(*traitsOf(scene.closures[c].type).free_axis);
  }
  compute(drives, given, start_ns, file);
  for (std::size_t i = 0; i < units.size(); ++i) {
    const std::string& name = columns_.joints[i];
    const Names& joints = file.table.joints;
    const auto found = std::find(joints.begin(), joints.end(), name);
    if (found == joints.end()) continue;
    Eigen::VectorXd positions =
        takenColumn(static_cast<std::size_t>(found - joints.begin()), file.table);
    if (degrees && units[i] == Unit::kRadian) positions *= kDegree;
    noteDifference(name, units[i], positions, columns_.positions.col(static_cast<Eigen::Index>(i)),
                   file);
  }
}

// Sets the columns in all rows.
void DrivenRows::compute(Drives& drives, const Given& given, std::int64_t start_ns,
                         const MotionFile& file) {
  std::vector<Eigen::Index> places;  // of closures, in the driven numbers
  for (const std::size_t c : drives.closures()) {
    places.push_back(std::find(given.closures.begin(), given.closures.end(), c) -
                     given.closures.begin());
  }
  const std::vector<double>& times = file.table.times;
  for (Eigen::MatrixXd* level :
       {&columns_.positions, &columns_.velocities, &columns_.accelerations}) {
    level->resize(static_cast<Eigen::Index>(times.size()),
                  static_cast<Eigen::Index>(columns_.joints.size()));
  }
  Motion motion(static_cast<Eigen::Index>(drives.coordinates().size()));
  Motion driven(static_cast<Eigen::Index>(given.drivenNumbers()));
  for (std::size_t row = 0; row < times.size(); ++row) {
    const bool by_stamp = start_ns != 0 && !file.stamps_ns.empty();
    const double time =
        by_stamp ? static_cast<double>(file.stamps_ns[row] - start_ns) / 1e9 : times[row];
    if (const auto none = drives.evaluate(time, given, motion, driven)) {
      throw FileError(file.at(row) + ": " + drives.whyNone(*none, time));
    }
    const auto set = [&](Eigen::MatrixXd& columns, const Eigen::VectorXd& coordinates,
                         const Eigen::VectorXd& numbers) {
      Eigen::Index column = 0;
      const auto at = static_cast<Eigen::Index>(row);
      for (const Eigen::Index i : coordinates_) columns(at, column++) = coordinates[i];
      for (const Eigen::Index i : places) columns(at, column++) = numbers[i];
    };
    set(columns_.positions, motion.q, driven.q);
    set(columns_.velocities, motion.qd, driven.qd);
    set(columns_.accelerations, motion.qdd, driven.qdd);
  }
}

Eigen::VectorXd DrivenRows::firstOfClosures() const {
  if (closures_ == 0) return Eigen::VectorXd();
  return columns_.positions.row(0).tail(static_cast<Eigen::Index>(closures_)).transpose();
}

void DrivenRows::placeFirst(Eigen::VectorXd& q) const {
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    q[coordinates_[i]] = columns_.positions(0, static_cast<Eigen::Index>(i));
  }
}

void DrivenRows::setCoordinates(MotionTable& table) const {
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    const auto from = static_cast<Eigen::Index>(i);
    table.positions.col(coordinates_[i]) = columns_.positions.col(from);
    table.velocities.col(coordinates_[i]) = columns_.velocities.col(from);
    table.accelerations.col(coordinates_[i]) = columns_.accelerations.col(from);
  }
}

void DrivenRows::insertClosures(Eigen::Index place, MotionTable& table) const {
  if (closures_ == 0) return;
  const auto count = static_cast<Eigen::Index>(closures_);
  const auto insert = [&](const Eigen::MatrixXd& columns, Eigen::MatrixXd& to) {
    const Eigen::MatrixXd all = to;
    const Eigen::Index after = all.cols() - place;
    to.resize(columns.rows(), place + count + after);
    if (place > 0) to.leftCols(place) = all.leftCols(place);
    to.middleCols(place, count) = columns.rightCols(count);
    if (after > 0) to.rightCols(after) = all.rightCols(after);
  };
  insert(columns_.positions, table.positions);
  insert(columns_.velocities, table.velocities);
  insert(columns_.accelerations, table.accelerations);
}

}  // namespace virtual_work_dynamics
