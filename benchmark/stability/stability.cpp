
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <mutex>
#include <thread>

#include "base/output_file.h"
#include "stability/measure.h"
#include "stability/stability_options.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

// No multiple of a pack, so that blocks end in part of one.
constexpr int kStatesOfTask = 21, kQuickStatesOfTask = 25;
constexpr int kTasksOfValue = 20;  // for each kind of numbers
// Mechanisms of so many joints take long in 113 bits.
constexpr std::size_t kManyJoints = 500;
constexpr int kTasksOfManyJoints = 10;
// The exact equations of loops take the cube of the number of joints.
constexpr std::size_t kManyJointsInLoops = 20;
constexpr int kTasksOfManyLoops = 2;

struct Task {
  std::size_t sweep, value;
  InputNumbers numbers;
  std::uint32_t seed;
};

// Of one scene and value.
struct Row {
  Verdict of_double, of_float;
};

std::vector<Sweep> wantedSweeps(const std::vector<std::string>& names) {
  std::vector<Sweep> all = treeSweeps();
  for (const Sweep& sweep : loopSweeps()) all.push_back(sweep);
  if (names.empty()) return all;
  std::vector<Sweep> wanted;
  for (const std::string& name : names) {
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const Sweep& sweep) { return sweep.scene == name; });
    if (found == all.end()) {
      throw OptionError("--scene: there is no scene '" + name + "'; --list names all");
    }
    wanted.push_back(*found);
  }
  return wanted;
}

int taskCountOf(const StabilityCase& stability_case) {
  const std::size_t joints = stability_case.mechanism.joints().size();
  if (needsClosedLoops(stability_case.scene)) {
    return joints >= kManyJointsInLoops ? kTasksOfManyLoops : kTasksOfValue;
  }
  return joints >= kManyJoints ? kTasksOfManyJoints : kTasksOfValue;
}

std::vector<Task> tasksOf(const std::vector<Sweep>& sweeps, bool quick) {
  std::vector<Task> tasks;
  for (std::size_t s = 0; s < sweeps.size(); ++s) {
    for (std::size_t v = 0; v < sweeps[s].values.size(); ++v) {
      const int count = quick ? 1 : taskCountOf(sweeps[s].make(sweeps[s].values[v]));
      for (int i = 0; i < count; ++i) {
        const std::uint32_t seed = static_cast<std::uint32_t>(1000 * v + 2 * i + 1);
        tasks.push_back({s, v, InputNumbers::kDouble, seed});
        tasks.push_back({s, v, InputNumbers::kFloat, seed + 1});
      }
    }
  }
  return tasks;
}

// Rows of every sweep, computed by several threads; the results do not depend on their number.
class Measurement {
 public:
  Measurement(const std::vector<Sweep>& sweeps, bool quick)
      : sweeps_(sweeps), quick_(quick), tasks_(tasksOf(sweeps, quick)) {
    for (const Sweep& sweep : sweeps) rows_.emplace_back(sweep.values.size());
  }

  const std::vector<std::vector<Row>>& run(int threads) {
    std::vector<std::thread> others;
    for (int i = 1; i < threads; ++i) others.emplace_back([this] { work(); });
    work();
    for (std::thread& thread : others) thread.join();
    clearProgress();
    if (failure_) std::rethrow_exception(failure_);
    return rows_;
  }

 private:
  void work() {
    for (std::size_t i = next_++; i < tasks_.size(); i = next_++) {
      try {
        compute(tasks_[i]);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex_);
        failure_ = std::current_exception();
        next_ = tasks_.size();
      }
    }
  }

  void compute(const Task& task) {
    const Sweep& sweep = sweeps_[task.sweep];
    const StabilityCase stability_case = sweep.make(sweep.values[task.value]);
    const Verdict verdict = measureStates(stability_case, task.numbers, task.seed,
                                          quick_ ? kQuickStatesOfTask : kStatesOfTask);
    const std::lock_guard<std::mutex> lock(mutex_);
    Row& row = rows_[task.sweep][task.value];
    (task.numbers == InputNumbers::kFloat ? row.of_float : row.of_double).include(verdict);
    ++done_;
    showProgress(sweep.scene, done_, tasks_.size());
  }

  const std::vector<Sweep>& sweeps_;
  bool quick_;
  std::vector<Task> tasks_;
  std::atomic<std::size_t> next_{0};
  std::mutex mutex_;  // of all below
  std::size_t done_ = 0;
  std::vector<std::vector<Row>> rows_;
  std::exception_ptr failure_;
};

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string csv(const std::vector<Sweep>& sweeps, const std::vector<std::vector<Row>>& rows) {
  std::string text =
      "scene,parameter,value,path,precision,error_over_bound,max_relative_error,"
      "one_ulp_sensitivity,kdl_relative_error\n";
  for (std::size_t s = 0; s < sweeps.size(); ++s) {
    for (std::size_t v = 0; v < rows[s].size(); ++v) {
      const std::optional<Errors>& kdl = rows[s][v].of_double.kdl;
      for (const Verdict* verdict : {&rows[s][v].of_double, &rows[s][v].of_float}) {
        for (const PathVerdict& path : verdict->paths) {
          text += sweeps[s].scene + ',' + sweeps[s].parameter + ',' + number(sweeps[s].values[v]) +
                  ',' + path.path + ',' + path.precision + ',' + number(path.errors.over_bound) +
                  ',' + number(path.errors.relative) + ',' + number(verdict->sensitivity) + ',' +
                  (kdl ? number(kdl->relative) : "") + '\n';
        }
      }
    }
  }
  return text;
}

std::string treeDetails(const Verdict& verdict) {
  const std::optional<WorstCertificates>& found = verdict.certificates;
  if (!found) return ",,,,,,";
  return ',' + number(found->worst.power) + ',' + number(found->worst.ground_force) + ',' +
         number(found->worst.ground_moment) + ',' + number(found->limit) + ',' +
         (verdict.kdl ? number(verdict.kdl->over_bound) : "") + ',' +
         number(verdict.overSubtreeBound("double"));
}

std::string loopDetails(const Verdict& verdict) {
  if (!verdict.loops) return ",,,,,,,,,,,";
  const LoopVerdict& loops = *verdict.loops;
  std::string text = ',' + number(loops.condition);
  for (const int count : {loops.rank, loops.redundancy, loops.redundant_constraints,
                          loops.free_motions, loops.open, loops.components, loops.apart}) {
    text += ',' + std::to_string(count);
  }
  return text + ',' + number(loops.residual) + ',' + std::to_string(loops.completed) + ',' +
         std::to_string(loops.states);
}

// Of double alone, one line for each value of a scene.
std::string detailsCsv(const std::vector<Sweep>& sweeps,
                       const std::vector<std::vector<Row>>& rows) {
  std::string text =
      "scene,parameter,value,certificate_power,certificate_ground_force,"
      "certificate_ground_moment,certificate_limit,kdl_error_over_bound,"
      "error_over_subtree_bound,loop_condition,loop_rank,loop_redundancy,"
      "loop_redundant_constraints,loop_free_motions,loop_open,loop_components,loop_apart,"
      "loop_residual_over_limit,loop_completed,loop_states\n";
  for (std::size_t s = 0; s < sweeps.size(); ++s) {
    for (std::size_t v = 0; v < rows[s].size(); ++v) {
      const Verdict& verdict = rows[s][v].of_double;
      text += sweeps[s].scene + ',' + sweeps[s].parameter + ',' + number(sweeps[s].values[v]) +
              treeDetails(verdict) + loopDetails(verdict) + '\n';
    }
  }
  return text;
}

void writeFile(const std::string& path, const std::string& text) {
  OutputFile output(path);
  output.write(text);
  output.commit();
}

// So that no minutes of computing are lost to a wrong path. OutputFile leaves nothing behind.
void requireWritable(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    if (!path.empty()) OutputFile{path};
  }
}

// The path that came closest to the bound, or went beyond it, in words.
struct Worst {
  double over_bound = -1;
  std::string words;

  void take(const Sweep& sweep, double value, const PathVerdict& path) {
    if (path.errors.over_bound <= over_bound) return;
    over_bound = path.errors.over_bound;
    words = sweep.scene + " at " + number(value) + ": " + path.precision + ' ' + path.path + ", " +
            path.errors.worst;
  }
  void take(const Sweep& sweep, const std::vector<Row>& rows) {
    for (std::size_t v = 0; v < rows.size(); ++v) {
      for (const Verdict* verdict : {&rows[v].of_double, &rows[v].of_float}) {
        for (const PathVerdict& path : verdict->paths) take(sweep, sweep.values[v], path);
      }
    }
  }
};

// The largest certificate, and the one that came closest to its limit or went beyond it: limits are
// not all the same.
struct WorstCertified {
  double largest = 0, over_limit = -1;
  std::string of_largest, of_closest;

  void take(const Sweep& sweep, const std::vector<Row>& rows) {
    for (std::size_t v = 0; v < rows.size(); ++v) {
      const std::optional<WorstCertificates>& found = rows[v].of_double.certificates;
      if (!found) continue;
      const std::string words = number(found->worst.largest()) + ", " + sweep.scene + " at " +
                                number(sweep.values[v]) + ", " + found->worstName();
      if (found->worst.largest() >= largest) {
        largest = found->worst.largest();
        of_largest = words;
      }
      if (found->overLimit() > over_limit) {
        over_limit = found->overLimit();
        of_closest = words;
      }
    }
  }
};

// Says where closed loops are not what they are exactly, or not closed; true where all are.
bool loopsAreRight(const std::vector<Sweep>& sweeps, const std::vector<std::vector<Row>>& rows) {
  bool right = true;
  const auto wrong = [&](const Sweep& sweep, double value, const std::string& what) {
    right = false;
    std::fprintf(stderr, "stability: %s at %s: %s\n", sweep.scene.c_str(), number(value).c_str(),
                 what.c_str());
  };
  for (std::size_t s = 0; s < sweeps.size(); ++s) {
    for (std::size_t v = 0; v < rows[s].size(); ++v) {
      const std::optional<LoopVerdict>& loops = rows[s][v].of_double.loops;
      if (!loops) continue;
      const double value = sweeps[s].values[v];
      if (loops->apart > 0) {
        wrong(sweeps[s], value,
              std::to_string(loops->apart) +
                  " counts or flags differ from the exact ones: " + loops->worst_apart);
      }
      if (loops->residual > 1) {
        wrong(sweeps[s], value,
              "completed motions leave " + number(loops->residual) + " times the limit open");
      }
    }
  }
  return right;
}

int report(const std::vector<Sweep>& sweeps, const std::vector<std::vector<Row>>& rows) {
  Worst worst;
  WorstCertified certified;
  for (std::size_t s = 0; s < sweeps.size(); ++s) {
    Worst of_scene;
    of_scene.take(sweeps[s], rows[s]);
    std::printf("%-24s %9s of the bound  %s\n", sweeps[s].scene.c_str(),
                number(of_scene.over_bound).c_str(), of_scene.words.c_str());
    worst.take(sweeps[s], rows[s]);
    certified.take(sweeps[s], rows[s]);
  }
  if (worst.over_bound > 1) {
    std::fprintf(stderr, "stability: %s times the bound: %s\n", number(worst.over_bound).c_str(),
                 worst.words.c_str());
  }
  if (certified.over_limit > 1) {
    std::fprintf(stderr, "stability: a certificate is %s times its limit: %s\n",
                 number(certified.over_limit).c_str(), certified.of_closest.c_str());
  }
  const bool loops_are_right = loopsAreRight(sweeps, rows);
  if (worst.over_bound > 1 || certified.over_limit > 1 || !loops_are_right) return 1;
  if (certified.over_limit < 0) {
    std::printf("all stable\n");
    return 0;
  }
  std::printf("all stable; worst certificate %s; closest to its limit, %s of it: %s\n",
              certified.of_largest.c_str(), number(certified.over_limit).c_str(),
              certified.of_closest.c_str());
  return 0;
}

int run(const StabilityOptions& options) {
  if (!options.output.empty() && options.output == options.details) {
    throw OptionError("--output and --details both name '" + options.output + "'");
  }
  const std::vector<Sweep> sweeps = wantedSweeps(options.scenes);
  if (options.list) {
    for (const Sweep& sweep : sweeps) {
      std::printf("%-24s %s\n", sweep.scene.c_str(), sweep.parameter.c_str());
    }
    return 0;
  }
  requireWritable({options.output, options.details});
  const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  Measurement measurement(sweeps, options.quick);
  const auto& rows = measurement.run(options.threads > 0 ? options.threads : cores);
  if (!options.output.empty()) writeFile(options.output, csv(sweeps, rows));
  if (!options.details.empty()) writeFile(options.details, detailsCsv(sweeps, rows));
  return report(sweeps, rows);
}

}  // namespace
}  // namespace virtual_work_dynamics

int main(int argc, char** argv) {
  using namespace virtual_work_dynamics;
  StabilityOptions options;
  return runProgram("stability", kStabilityHelp, argc, argv, commandLine(options),
                    [&] { return run(options); });
}
