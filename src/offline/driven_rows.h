#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "offline/motion_file.h"
#include "virtual_work_dynamics/drives.h"
#include "virtual_work_dynamics/given.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// The motion of what a scene drives, in the rows of a file whose times are those of the drives, or
/// whose stamps tell them.
class DrivenRows {
 public:
  DrivenRows() = default;
  /// Takes the columns of what is driven off a file, where it has them. They are not used: notes on
  /// standard error say by how much they differ.
  /// @param degrees whether they have angles in degrees
  /// @param given what the motion gives, with what is driven
  /// @param start_ns see RecordingOptions::drive_start_ns
  /// @throws FileError naming the row whose time the drives have no motion for.
  DrivenRows(const Mechanism& mechanism, const Scene& scene, const Given& given, bool degrees,
             std::int64_t start_ns, MotionFile& file);

  bool empty() const { return columns_.positions.size() == 0; }
  /// Number of closures that are driven.
  std::size_t closures() const { return closures_; }
  /// Their positions in the first row.
  Eigen::VectorXd firstOfClosures() const;
  /// Sets the positions of driven coordinates in the first row.
  void placeFirst(Eigen::VectorXd& q) const;
  /// Sets the columns of driven coordinates in a table of all coordinates.
  void setCoordinates(MotionTable& table) const;
  /// Inserts the columns of driven closures before column `place`, if there are any.
  void insertClosures(Eigen::Index place, MotionTable& table) const;

 private:
  void compute(Drives& drives, const Given& given, std::int64_t start_ns, const MotionFile& file);

  std::vector<Eigen::Index> coordinates_;
  std::size_t closures_ = 0;
  MotionTable columns_;  // of the coordinates, then of the closures
};

}  // namespace virtual_work_dynamics
