#pragma once

#include <string>
#include <vector>

#include "offline/completed_motion.h"
#include "offline/row_loads.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/regressor.h"

namespace virtual_work_dynamics {

/// What --parameters asks for: `joints`, `links` and names of links.
/// @throws SceneError naming one that is neither.
std::vector<Parameter> askedParameters(const Mechanism& mechanism, const Scene& scene,
                                       const std::vector<std::string>& asked);

/// Writes the folder of --regressor: efforts as the description has them, and what they are per
/// unit of each parameter. Completes the motion. Memory does not grow with the number of
/// parameters.
/// @throws FileError when a file cannot be written, or as Computation.
class RegressorFiles {
 public:
  /// @param folder is made where it is not there
  RegressorFiles(std::string folder, const Mechanism& mechanism, const Scene& scene, int threads);

  void write(const Dynamics& dynamics, CompletedMotion& motion, const RowLoads& loads,
             const std::vector<Parameter>& parameters) const;

 private:
  void writeEfforts(const Dynamics& dynamics, CompletedMotion& motion, const RowLoads& loads) const;
  void writeMotion(const MotionTable& table) const;
  void writeRegressor(const MotionTable& table, const std::vector<Parameter>& parameters) const;
  void writeNames(const Dynamics& dynamics, const std::vector<Parameter>& parameters) const;
  std::string path(const std::string& file) const { return folder_ + "/" + file; }

  std::string folder_;
  const Mechanism& mechanism_;
  const Scene& scene_;
  int threads_;
};

}  // namespace virtual_work_dynamics
