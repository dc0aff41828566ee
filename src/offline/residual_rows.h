#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "offline/deviation_rows.h"
#include "offline/effort_comparison.h"
#include "offline/measured_efforts.h"
#include "offline/motion_file.h"
#include "offline/result_writer.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/momentum_observer.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// What measured efforts lack beside the computed ones, row by row: the external effort of each
/// joint, computed less measured.
class ResidualRows {
 public:
  /// @param measured what was measured; of joints without an effort it is left out, and so are
  ///   efforts without a measurement, each with a note on standard error
  /// @param max_gap s, between two measurements that are read on a straight line
  /// @param file of the rows, which must outlive it, as recorded
  /// @param where the efforts come from, for messages
  /// @throws FileError, one line, when nothing was measured of the robot's joints, or at none of
  ///   the rows' instants.
  ResidualRows(const Mechanism& mechanism, const Dynamics& dynamics, const Scene& scene,
               MeasuredEfforts measured, double max_gap, const MotionFile& file,
               const std::string& where);

  /// Estimates external efforts by a momentum observer, too, which starts anew after a gap.
  /// @param gain 1/s
  /// @throws SceneError as MomentumObserver does.
  void observe(const Mechanism& mechanism, const Scene& scene, double gain);

  /// Names of its columns: measured efforts, residuals, external efforts where they are observed,
  /// and, where deviations are computed, those of the residuals.
  std::vector<std::string> columns(bool deviations) const;
  /// Adds the cells of a row. @param load of the row
  /// @param effort that is written, NaN where it does not exist
  /// @param deviations that were added for the same row; null: none are
  /// @throws FileError when the time of an observed row is not later than that of the one before.
  void add(std::size_t row, const Motion& motion, const Load& load, const Eigen::VectorXd& effort,
           const DeviationRows* deviations, std::vector<double>& cells);

  /// The comparison of all rows that were added, line by line.
  std::string table() const;

 private:
  struct Joint {
    Eigen::Index effort;  // place among the efforts
    MeasuredEffort measured;
    ComparedEfforts compared;
  };

  void checkOverlap(const std::string& where) const;
  void addObserved(std::size_t row, const Motion& motion, const Load& load,
                   std::vector<double>& cells);

  const MotionFile& file_;
  const std::int64_t max_gap_ns_;
  std::vector<Joint> joints_;
  std::optional<MomentumObserver> observer_;
  Eigen::VectorXd measured_;  // of the row, by coordinate; NaN: not known
};

}  // namespace virtual_work_dynamics
