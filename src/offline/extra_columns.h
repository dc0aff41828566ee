#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "offline/arguments.h"
#include "offline/certified_rows.h"
#include "offline/deviation_rows.h"
#include "offline/hold_rows.h"
#include "offline/limit_rows.h"
#include "offline/measured_efforts.h"
#include "offline/motion_file.h"
#include "offline/report_columns.h"
#include "offline/residual_rows.h"
#include "offline/result_writer.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/results.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// What the command line asks of each row besides its results: the columns that stand after them,
/// and what is said of all rows at the end.
class ExtraColumns {
 public:
  /// @param dynamics of which results are; all arguments must outlive it
  /// @param written the results that are written
  /// @param file whose rows are computed
  /// @param measured efforts, empty unless residuals are asked for
  /// @param columns of the results; receives the names of these
  /// @throws SceneError when a momentum observer cannot serve the scene
  /// @throws Error, one line, when deviations or residuals have nothing to be made of.
  ExtraColumns(const Arguments& arguments, const Mechanism& mechanism, const Scene& scene,
               const Dynamics& dynamics, const Request& written, const MotionFile& file,
               MeasuredEfforts measured, Columns& columns);

  /// Adds the cells of a row. @param load with which `results` were computed
  /// @param effort that is written, NaN where it does not exist
  void add(std::size_t row, const Motion& motion, const Load& load, const Results& results,
           const Eigen::VectorXd& effort, std::vector<double>& cells);

  /// Lines on what was found in all rows.
  std::string notes() const;

 private:
  const Arguments& arguments_;
  const Mechanism& mechanism_;
  const MotionFile& file_;
  std::optional<CertifiedRows> certified_;
  std::optional<DeviationRows> deviations_;
  std::optional<ResidualRows> residuals_;
  std::optional<ReportColumns> report_;
  std::optional<LimitRows> limits_;
  HoldRows holds_;
};

}  // namespace virtual_work_dynamics
