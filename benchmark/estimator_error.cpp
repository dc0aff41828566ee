// Error of the estimated motion, and of the efforts computed from it, for joint states as encoders
// give them, as rows of a CSV.
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "base/output_file.h"
#include "command_line.h"
#include "estimator/report_parts.h"
#include "estimator/report_streams.h"
#include "offline/progress.h"

using namespace virtual_work_dynamics;

namespace {

constexpr char kHelp[] =
    R"(estimator_error: error of efforts computed from estimated motions

  estimator_error [--output FILE] [--quick] [--recording FOLDER]
  estimator_error --long-run SAMPLES [--output FILE]

The six-axis arm moves in a way that is known exactly. Its joint states are sampled, read by encoders
and given to the estimator and to its alternatives; efforts computed from what comes out are compared
with the exact ones. Every row of the result is one figure.

  --output FILE        result as CSV (default: standard output); FILE is complete or not there
  --quick              a few of the streams, for a look in seconds
  --recording FOLDER   also judge by a real recording: panda_nohand.urdf, panda_2s_motion.csv and
                       panda_2s_measured_torque.csv
  --long-run SAMPLES   instead of all that: one joint that turns on for so many samples at 1 kHz
  --help               this text

Exit status: 0 done, 1 something is wrong with a robot, a recording or the output, 2 wrong usage.
)";

bool readable(const std::string& path) {
  return std::ifstream(path).good();
}

void measureAll(bool quick, const std::string& recording, const ReportRows& rows) {
  const Arm arm = Arm::read();
  const std::vector<StreamSpec> grid = gridStreams(quick);
  const std::vector<StreamSpec> hard = hardStreams(quick);
  const std::vector<StreamSpec> wrong = wrongVelocityStreams(quick);
  const std::size_t total = 2 * (grid.size() + hard.size()) + wrong.size();
  Progress progress(std::cerr, ProgressLine::whereIs(STDERR_FILENO), "streams");
  std::size_t done = 0;
  for (const std::vector<StreamSpec>* streams : {&grid, &hard})
    for (const StreamSpec& spec : *streams) {
      progress.update(done, total);
      measureOffline(arm, spec, rows);
      progress.update(done + 1, total);
      measureNode(arm, spec, rows);
      done += 2;
    }
  for (const StreamSpec& spec : wrong) {
    progress.update(done++, total);
    measureWrongVelocities(arm, spec, rows);
  }
  measureTime(arm, quick, rows);
  measureDeviationCost(arm, rows);
  if (recording.empty()) return;
  if (readable(recording + "/panda_2s_motion.csv")) {
    measureRecorded(recording, rows);
  } else {
    std::cerr << "estimator_error: " << recording << " has no recording; left out\n";
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::string output;
  std::string recording;
  bool quick = false;
  int long_run = 0;
  return runProgram("estimator_error", kHelp, argc, argv,
                    {text("--output", output), flag("--quick", quick),
                     text("--recording", recording), count("--long-run", 9, long_run)},
                    [&] {
                      OutputFile file(output);
                      file.write(ReportRows::kHeader);
                      const ReportRows rows([&](const std::string& row) { file.write(row); });
                      if (long_run > 0) {
                        measureLongRun(long_run, rows);
                      } else {
                        measureAll(quick, recording, rows);
                      }
                      file.commit();
                      return 0;
                    });
}
