#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "base/worker_threads.h"
#include "offline/built_library.h"
#include "virtual_work_dynamics/instruction_set.h"
#include "virtual_work_dynamics/load.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion_table.h"
#include "virtual_work_dynamics/request.h"
#include "virtual_work_dynamics/results.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Computes rows of a MotionTable a block at a time by code that is generated for the scene and
/// compiled now. Its results are those of SampleRows to the last bit, except that a zero may have
/// the other sign.
class CompiledRows {
 public:
  /// Generates and compiles the code.
  /// @throws Error, one line: why there is none.
  CompiledRows(const Mechanism& mechanism, const Scene& scene, const Request& request,
               InstructionSet instruction_set);

  /// Makes room for blocks of so many rows, which are divided among threads.
  void makeRoom(std::size_t capacity, int threads);

  /// Computes rows as SampleRows does, of a table that suits it.
  /// @param load of all rows, unless `loads` are those of each
  /// @returns false where a number is so large that an operation may overflow: the code leaves
  ///   products with zeros out, whose results then would be other ones.
  bool compute(const MotionTable& table, std::size_t first, std::size_t count, const Load& load,
               const Load* loads);

  /// Results of row `index` of the last block.
  const Results& read(std::size_t index);

 private:
  // Arrays of a block: number c of row n is at [c * capacity_ + n].
  struct Array {
    std::size_t numbers;
    std::vector<double> values;
  };
  using Function = void (*)(std::size_t samples, std::size_t stride, const double* const* inputs,
                            double* const* outputs);

  std::string wrapped(const std::string& source) const;
  void take(const MotionTable& table, std::size_t first, std::size_t count, const Load& load,
            const Load* loads);
  bool allWithin(double limit, std::size_t count, const std::vector<Array>& arrays) const;
  void computeShare(std::size_t count, std::size_t thread);

  const bool static_motion_;
  const Eigen::Vector3d gravity_;  // m/s^2, inertial axes
  std::vector<Array> inputs_, outputs_;
  std::size_t root_ = 0, orientations_ = 0, applied_ = 0;  // places in inputs_; 0: there is none
  std::unique_ptr<const BuiltLibrary> library_;
  Function function_ = nullptr;
  std::size_t capacity_ = 0;
  WorkerThreads workers_{1};
  Results results_;
};

}  // namespace virtual_work_dynamics
