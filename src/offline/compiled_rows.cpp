#include "offline/compiled_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "offline/generated_files.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/generated_code.h"
#include "virtual_work_dynamics/root_motion.h"

namespace virtual_work_dynamics {
namespace {

constexpr char kName[] = "rows";
// Products of a sample are of a few numbers: of such ones none overflows.
constexpr double kLargest = 1e30;
constexpr std::size_t kPack = 8;  // the most samples side by side
constexpr std::size_t kMostArrays = 6;

// Columns of a table, the rows from `first` on.
template <typename Array>
void copyColumns(const Eigen::MatrixXd& columns, std::size_t first, std::size_t count,
                 std::size_t stride, Array& to) {
  for (std::size_t c = 0; c < to.numbers; ++c) {
    const double* const from = columns.col(static_cast<Eigen::Index>(c)).data() + first;
    std::copy_n(from, count, to.values.data() + c * stride);
  }
}

template <typename Array>
void copyRow(const double* from, std::size_t row, std::size_t stride, Array& to) {
  for (std::size_t c = 0; c < to.numbers; ++c) to.values[c * stride + row] = from[c];
}

GeneratedCode codeOf(const Mechanism& mechanism, const Scene& scene, const Request& request) {
  GeneratedCodeOptions options;
  options.name = kName;
  GeneratedCode code = generateCode(mechanism, scene, request, options);
  if (code.multiplications + code.additions > kMostWorthwhile) {
    throw Error("the robot is so large that nothing would be gained");
  }
  if (!(code.largest_number <= kLargest)) {
    throw Error("the description or the scene has numbers beyond 1e30");
  }
  return code;
}

}  // namespace

CompiledRows::CompiledRows(const Mechanism& mechanism, const Scene& scene, const Request& request,
                           InstructionSet instruction_set)
    : static_motion_(scene.static_motion), gravity_(scene.gravity) {
  const std::size_t coordinates = mechanism.coordinates().size();
  const auto add = [](std::vector<Array>& arrays, std::size_t numbers) {
    if (numbers > 0) arrays.push_back({numbers, {}});
    return arrays.size() - 1;
  };
  inputs_.assign(3, {coordinates, {}});
  if (scene.root_moves) root_ = add(inputs_, RootState::kNumbers);
  if (mechanism.orientations() > 0) orientations_ = add(inputs_, 4 * mechanism.orientations());
  if (!scene.applied_wrenches.empty()) applied_ = add(inputs_, 6 * scene.applied_wrenches.size());
  results_.effort.setZero(request.efforts ? static_cast<Eigen::Index>(coordinates) : 0);
  results_.child_axes.resize(request.child_axes.size());
  results_.root_axes.resize(request.root_axes.size());
  add(outputs_, static_cast<std::size_t>(results_.effort.size()));
  add(outputs_, 6 * results_.child_axes.size());
  add(outputs_, 6 * results_.root_axes.size());

  const GeneratedCode code = codeOf(mechanism, scene, request);
  library_ = std::make_unique<BuiltLibrary>(kName, code.header, wrapped(code.source),
                                            optionsFor(instruction_set, kName));
  function_ = reinterpret_cast<Function>(library_->function("rows_of_table"));
}

// The source with a function whose arguments do not depend on the scene. The compiler refuses it
// where the arrays are not those of the generated function.
std::string CompiledRows::wrapped(const std::string& source) const {
  std::string arguments = "samples, stride";
  for (std::size_t i = 0; i < inputs_.size(); ++i) arguments += ", in[" + std::to_string(i) + "]";
  for (std::size_t i = 0; i < outputs_.size(); ++i) arguments += ", out[" + std::to_string(i) + "]";
  return source +
         "\nvoid rows_of_table(size_t samples, size_t stride, const double *const *in, "
         "double *const *out) {\n  rows_compute_block(" +
         arguments + ");\n}\n";
}

void CompiledRows::makeRoom(std::size_t capacity, int threads) {
  capacity_ = capacity;
  workers_ = WorkerThreads(threads);
  for (auto* arrays : {&inputs_, &outputs_}) {
    for (Array& array : *arrays) array.values.resize(array.numbers * capacity);
  }
}

void CompiledRows::take(const MotionTable& table, std::size_t first, std::size_t count,
                        const Load& load, const Load* loads) {
  const Eigen::MatrixXd* const kJoints[] = {&table.positions, &table.velocities,
                                            &table.accelerations};
  for (std::size_t i = 0; i < 3; ++i) {
    copyColumns(*kJoints[i], first, count, capacity_, inputs_[i]);
  }
  if (orientations_ > 0 && table.orientations.size() > 0) {
    copyColumns(table.orientations, first, count, capacity_, inputs_[orientations_]);
  } else if (orientations_ > 0) {  // joints that turn freely are not turned
    Array& array = inputs_[orientations_];
    for (std::size_t c = 0; c < array.numbers; ++c) {
      std::fill_n(array.values.data() + c * capacity_, count, c % 4 == 3 ? 1 : 0);
    }
  }
  for (std::size_t row = 0; row < count; ++row) {
    if (root_ > 0) {
      const RootState state(table.roots[first + row], gravity_, static_motion_);
      copyRow(state.data(), row, capacity_, inputs_[root_]);
    }
    if (applied_ > 0) {
      const Load& own = loads ? loads[row] : load;
      copyRow(own.wrenches.front().force.data(), row, capacity_, inputs_[applied_]);
    }
  }
}

bool CompiledRows::compute(const MotionTable& table, std::size_t first, std::size_t count,
                           const Load& load, const Load* loads) {
  take(table, first, count, load, loads);
  if (!allWithin(kLargest, count, inputs_)) return false;
  struct Job {
    CompiledRows& all;
    std::size_t count;
  } job{*this, count};
  workers_.run(
      [](void* context, int index) {
        const Job& of = *static_cast<Job*>(context);
        of.all.computeShare(of.count, static_cast<std::size_t>(index));
      },
      &job);
  return allWithin(std::numeric_limits<double>::max(), count, outputs_);
}

bool CompiledRows::allWithin(double limit, std::size_t count,
                             const std::vector<Array>& arrays) const {
  bool all = true;
  for (const Array& array : arrays) {
    for (std::size_t c = 0; c < array.numbers; ++c) {
      const double* const column = array.values.data() + c * capacity_;
      for (std::size_t row = 0; row < count; ++row) all &= std::abs(column[row]) <= limit;
    }
  }
  return all;
}

// Computes the samples of one thread, which are whole packs for all threads except the last.
void CompiledRows::computeShare(std::size_t count, std::size_t thread) {
  const std::size_t threads = static_cast<std::size_t>(workers_.count());
  const std::size_t packs = (count + kPack - 1) / kPack;
  const std::size_t begin = packs * thread / threads * kPack;
  const std::size_t end = std::min(count, packs * (thread + 1) / threads * kPack);
  if (begin >= end) return;
  std::array<const double*, kMostArrays> in{};
  std::array<double*, kMostArrays> out{};
  for (std::size_t i = 0; i < inputs_.size(); ++i) in[i] = inputs_[i].values.data() + begin;
  for (std::size_t i = 0; i < outputs_.size(); ++i) out[i] = outputs_[i].values.data() + begin;
  function_(end - begin, capacity_, in.data(), out.data());
}

const Results& CompiledRows::read(std::size_t index) {
  std::size_t array = 0, c = 0;
  const auto next = [&] {
    if (c == outputs_[array].numbers) {
      ++array;
      c = 0;
    }
    return outputs_[array].values[c++ * capacity_ + index];
  };
  for (Eigen::Index i = 0; i < results_.effort.size(); ++i) results_.effort[i] = next();
  for (auto* wrenches : {&results_.child_axes, &results_.root_axes}) {
    for (Wrench& wrench : *wrenches) {
      for (Eigen::Vector3d* part : {&wrench.force, &wrench.torque}) {
        for (int i = 0; i < 3; ++i) (*part)[i] = next();
      }
    }
  }
  return results_;
}

}  // namespace virtual_work_dynamics
