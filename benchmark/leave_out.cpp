// Operations, run time and numbers of plans that compute less than everything.
#include <time.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "base/output_file.h"
#include "command_line.h"
#include "contenders/robots.h"
#include "cores.h"
#include "omissions.h"
#include "same_numbers.h"

namespace virtual_work_dynamics {
namespace {

constexpr char kHelp[] =
    R"(leave_out: what a plan saves by leaving out what nobody asked for

  leave_out [--output FILE] [--quick]

For several robots: the plan that computes everything, and plans that leave something out; how many
multiplications and additions each takes, how long, and whether the numbers that remain are the
same as with what was left out, over 100 random states.

  --output FILE   results as CSV; FILE is complete or not there
  --quick         shorter and fewer rounds
  --help          this text

Times are medians of rounds in which all plans of a robot take turns on one core.
same_numbers: yes, bit for bit except for signs of zeros; otherwise the largest difference, over the
largest number of the same kind in the same state.

Exit status: 0 done, 1 something is wrong, 2 wrong usage.
)";

constexpr std::size_t kStatesToCompare = 100;
constexpr const char* kScenes[] = {"pendulum", "six_axis_arm", "ur5", "tiago_no_hand"};
constexpr char kSceneWithLeaves[] = "six_axis_arm";

struct Extent {
  int rounds;
  double seconds;  // for each plan in a round
};
constexpr Extent kUsual{15, 10e-3};
constexpr Extent kQuick{7, 2e-3};

struct Row {
  std::string scene, left_out;
  PlanSummary summary;
  double ns = 0;
  std::string same_numbers;
};

__attribute__((format(printf, 1, 2))) std::string formatted(const char* format, ...) {
  char text[256];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof(text), format, arguments);
  va_end(arguments);
  return text;
}

// For which this thread has run.
double threadSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// A plan that goes round its states and is timed.
class Runner {
 public:
  Runner(const NamedPlan& plan, double seconds)
      : plan_(plan),
        workspace_(plan.dynamics.makeWorkspace()),
        states_(randomStates(plan, kStatesToTime)) {
    while (run() < seconds) laps_ *= 2;
  }

  void time() {
    runOnce();  // after the others, nothing of its own is in the caches
    ns_.push_back(1e9 * run() / static_cast<double>(laps_ * kStatesToTime));
  }

  double median() {
    std::nth_element(ns_.begin(), ns_.begin() + ns_.size() / 2, ns_.end());
    return ns_[ns_.size() / 2];
  }

 private:
  // Few enough that the inputs of a large robot stay in the nearest cache.
  static constexpr std::size_t kStatesToTime = 16;

  void runOnce() {
    for (const Motion& motion : states_) plan_.dynamics.compute(motion, workspace_);
  }
  double run() {
    const double start = threadSeconds();
    for (std::size_t lap = 0; lap < laps_; ++lap) runOnce();
    return threadSeconds() - start;
  }

  const NamedPlan& plan_;
  Workspace workspace_;
  std::vector<Motion> states_;
  std::size_t laps_ = 1;
  std::vector<double> ns_;
};

std::string sameNumbers(const Omission& omission) {
  if (!omission.with) return "reference";
  const Sameness sameness = compare(omission, kStatesToCompare);
  return sameness.identical ? "yes" : formatted("%.2g", sameness.largest_difference);
}

// @param place of the scene among `scenes` of them
std::vector<Row> measure(const OmissionScene& scene, const Extent& extent, std::size_t place,
                         std::size_t scenes) {
  const std::size_t steps = static_cast<std::size_t>(extent.rounds) + 1;
  const auto show = [&](std::size_t step) {
    showProgress(scene.name, place * steps + step, scenes * steps);
  };
  std::vector<Row> rows;
  std::vector<std::unique_ptr<Runner>> runners;
  show(0);
  for (const Omission& omission : scene.omissions) {
    rows.push_back({scene.name, omission.left_out, omission.plan->dynamics.summary(), 0,
                    sameNumbers(omission)});
    runners.push_back(std::make_unique<Runner>(*omission.plan, extent.seconds));
  }
  for (int round = 0; round < extent.rounds; ++round) {
    show(static_cast<std::size_t>(round) + 1);
    for (const auto& runner : runners) runner->time();
  }
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].ns = runners[i]->median();
  clearProgress();
  return rows;
}

std::string table(const std::vector<Row>& rows) {
  std::string text = formatted("\n%-58s %15s %10s %10s  %s\n", rows[0].scene.c_str(),
                               "multiplications", "additions", "ns/sample", "same numbers");
  for (const Row& row : rows) {
    text += formatted("%-58s %15zu %10zu %10.1f  %s\n", row.left_out.c_str(),
                      row.summary.multiplications, row.summary.additions, row.ns,
                      row.same_numbers.c_str());
  }
  return text;
}

std::string csv(const std::vector<Row>& rows) {
  std::string text = "scene,left_out,multiplications,additions,ns_per_sample,same_numbers\n";
  for (const Row& row : rows) {
    text +=
        row.scene + ',' + row.left_out +
        formatted(",%zu,%zu,%.6g,", row.summary.multiplications, row.summary.additions, row.ns) +
        row.same_numbers + '\n';
  }
  return text;
}

std::vector<OmissionScene> scenes() {
  std::vector<OmissionScene> found;
  for (const char* name : kScenes) {
    const std::string missing = missingFile(name);
    if (missing.empty()) {
      found.push_back(omissionsOf(makeScene(name)));
    } else {
      std::fprintf(stderr, "%s: skipped, %s is not there\n", name, missing.c_str());
    }
  }
  found.push_back(masslessLeavesOf(makeScene(kSceneWithLeaves)));
  return found;
}

void run(const std::string& path, const Extent& extent) {
  std::unique_ptr<OutputFile> output;
  if (!path.empty()) output = std::make_unique<OutputFile>(path);
  if (stayOnOneCore() < 0) {
    std::fprintf(stderr, "Not allowed to stay on one core; times may scatter.\n");
  }
  std::vector<Row> all_rows;
  const std::vector<OmissionScene> all = scenes();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::vector<Row> rows = measure(all[i], extent, i, all.size());
    std::printf("%s", table(rows).c_str());
    std::fflush(stdout);
    all_rows.insert(all_rows.end(), rows.begin(), rows.end());
  }
  if (output) {
    output->write(csv(all_rows));
    output->commit();
  }
}

}  // namespace
}  // namespace virtual_work_dynamics

int main(int argc, char** argv) {
  using namespace virtual_work_dynamics;
  std::string output;
  bool quick = false;
  return runProgram("leave_out", kHelp, argc, argv,
                    {text("--output", output), flag("--quick", quick)}, [&] {
                      run(output, quick ? kQuick : kUsual);
                      return 0;
                    });
}
