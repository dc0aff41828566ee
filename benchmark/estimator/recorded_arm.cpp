// The real recording: how much of the variance of measured torques computed ones explain.
#include <Eigen/Dense>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "estimator/butterworth.h"
#include "estimator/polynomial_window.h"
#include "estimator/report_parts.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/motion_completion.h"
#include "virtual_work_dynamics/motion_csv.h"
#include "virtual_work_dynamics/motion_estimator.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kCoulombVelocity = 0.02;               // rad/s, over which dry friction turns
constexpr double kLearnt = 1;                           // s, from which the node is judged
constexpr double kLags[] = {0, 0.01, 0.02, 0.05, 0.1};  // s, of the node

/// Numbers of a CSV with one line of header, without the first column.
Eigen::MatrixXd readTorques(const std::string& path, Eigen::Index columns) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  std::vector<double> cells;
  while (std::getline(file, line)) {
    std::stringstream stream(line);
    std::string cell;
    for (Eigen::Index i = 0; i <= columns && std::getline(stream, cell, ','); ++i)
      if (i > 0) cells.push_back(std::stod(cell));
  }
  const auto count = static_cast<Eigen::Index>(cells.size());
  if (count == 0 || count % columns != 0)
    throw FileError(path + ": not a table of a time and " + std::to_string(columns) + " torques");
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<Rows>(cells.data(), count / columns, columns);
}

class RecordedArm {
 public:
  explicit RecordedArm(const std::string& folder)
      : mechanism_(readUrdfFile(folder + "/panda_nohand.urdf")),
        dynamics_(mechanism_, withoutReactions()),
        motion_(readMotionCsv(folder + "/panda_2s_motion.csv", mechanism_.coordinateNames())),
        torques_(readTorques(folder + "/panda_2s_measured_torque.csv", motion_.positions.cols())) {
    if (torques_.rows() != motion_.positions.rows())
      throw FileError(folder + ": motion and torques have different numbers of rows");
  }

  const Mechanism& mechanism() const { return mechanism_; }
  const MotionTable& motion() const { return motion_; }

  /// Explained share of the variance, mean of all joints, after a fit of viscous and dry friction
  /// and an offset for each joint on the recorded velocities. Rows whose acceleration is NaN, and
  /// those before `from`, s after the first row, are left out.
  double explained(const Eigen::MatrixXd& q, const Eigen::MatrixXd& qd, const Eigen::MatrixXd& qdd,
                   double from) const {
    std::vector<Eigen::Index> rows;
    for (Eigen::Index row = 0; row < q.rows(); ++row)
      if (qdd.row(row).allFinite() &&
          motion_.times[static_cast<std::size_t>(row)] >= motion_.times[0] + from)
        rows.push_back(row);
    Workspace workspace = dynamics_.makeWorkspace();
    const auto count = static_cast<Eigen::Index>(rows.size());
    Eigen::MatrixXd left(count, q.cols());
    Eigen::MatrixXd measured(count, q.cols());
    Eigen::MatrixXd velocities(count, q.cols());
    Motion motion(q.cols());
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Index row = rows[static_cast<std::size_t>(i)];
      motion.q = q.row(row);
      motion.qd = qd.row(row);
      motion.qdd = qdd.row(row);
      dynamics_.compute(motion, workspace);
      measured.row(i) = torques_.row(row);
      left.row(i) = torques_.row(row) - workspace.effort().transpose();
      velocities.row(i) = motion_.velocities.row(row);
    }
    double sum = 0;
    for (Eigen::Index j = 0; j < q.cols(); ++j) sum += explainedOf(left, measured, velocities, j);
    return sum / static_cast<double>(q.cols());
  }

 private:
  static Scene withoutReactions() {
    Scene scene;
    scene.reactions = ReactionSelection::kNone;
    return scene;
  }

  static double variance(const Eigen::VectorXd& x) {
    return (x.array() - x.mean()).square().mean();
  }

  static double explainedOf(const Eigen::MatrixXd& left, const Eigen::MatrixXd& measured,
                            const Eigen::MatrixXd& velocities, Eigen::Index joint) {
    Eigen::MatrixXd friction(left.rows(), 3);
    friction.col(0) = velocities.col(joint);
    friction.col(1) = (velocities.col(joint).array() / kCoulombVelocity).tanh();
    friction.col(2).setOnes();
    const Eigen::VectorXd fit = friction.colPivHouseholderQr().solve(left.col(joint));
    return 1 - variance(left.col(joint) - friction * fit) / variance(measured.col(joint));
  }

  Mechanism mechanism_;
  InverseDynamics dynamics_;
  MotionTable motion_;
  Eigen::MatrixXd torques_;
};

double byCompletion(const RecordedArm& arm, bool velocities, double from) {
  MotionTable motion = arm.motion();
  if (!velocities) motion.velocities.resize(0, 0);
  motion = completeMotion(arm.mechanism(), motion);
  return arm.explained(motion.positions, motion.velocities, motion.accelerations, from);
}

double byNode(const RecordedArm& arm, double lag, double from) {
  EstimatorSettings settings;
  settings.lag = lag;
  MotionEstimator estimator(arm.mechanism(), settings);
  const MotionTable& table = arm.motion();
  const auto joints = static_cast<int>(table.positions.cols());
  std::vector<int> coordinates;
  for (int j = 0; j < joints; ++j) coordinates.push_back(j);
  Eigen::MatrixXd q = Eigen::MatrixXd::Constant(table.positions.rows(), joints, NAN);
  Eigen::MatrixXd qd = q;
  Eigen::MatrixXd qdd = q;
  std::vector<std::int64_t> stamps;
  std::size_t due = 0;
  Motion motion(joints);
  for (std::size_t row = 0; row < table.times.size(); ++row) {
    stamps.push_back(std::llround(1e9 * table.times[row]));
    const auto at = static_cast<Eigen::Index>(row);
    const Eigen::VectorXd positions = table.positions.row(at);
    const Eigen::VectorXd velocities = table.velocities.row(at);
    estimator.push(stamps.back(), coordinates.data(), positions.data(), velocities.data(), joints);
    while (estimator.ready()) {
      const std::int64_t instant = estimator.evaluate(motion);
      while (due < row && stamps[due] < instant) ++due;
      const auto then = static_cast<Eigen::Index>(due);
      q.row(then) = motion.q;
      qd.row(then) = motion.qd;
      qdd.row(then) = motion.qdd;
    }
  }
  return arm.explained(q, qd, qdd, from);
}

/// The best cutoff and order; the positions are filtered, and the velocities, or the slopes of the
/// positions instead of them.
double byButterworth(const RecordedArm& arm, double interval, double from) {
  double most = -HUGE_VAL;
  for (const double cutoff : {4, 5, 6, 7, 8, 10, 12, 15, 18, 20, 25})
    for (const int order : {2, 4})
      for (const bool velocities : {false, true}) {
        const Eigen::MatrixXd q =
            zeroPhaseLowPass(arm.motion().positions, cutoff * interval, order);
        const Eigen::MatrixXd qd =
            velocities ? zeroPhaseLowPass(arm.motion().velocities, cutoff * interval, order)
                       : gradient(q, interval);
        most = std::max(most, arm.explained(q, qd, gradient(qd, interval), from));
      }
  return most;
}

double bySavitzkyGolay(const RecordedArm& arm, double interval, double from) {
  double most = -HUGE_VAL;
  const Eigen::MatrixXd& positions = arm.motion().positions;
  const Eigen::MatrixXd& velocities = arm.motion().velocities;
  const Eigen::Index rows = positions.rows();
  for (Eigen::Index half = 15; half < 150; half += 6) {
    Eigen::MatrixXd q(rows, positions.cols());
    Eigen::MatrixXd qd[2] = {q, q};
    Eigen::MatrixXd qdd[2] = {q, q};
    const Eigen::Index window = 2 * half + 1;
    for (Eigen::Index row = 0; row < rows; ++row) {
      const Eigen::Index first = std::min(std::max<Eigen::Index>(row - half, 0), rows - window);
      const Eigen::VectorXd times =
          interval * Eigen::VectorXd::LinSpaced(window, static_cast<double>(first - row),
                                                static_cast<double>(first - row + window - 1));
      const Eigen::Matrix3Xd weights = polynomialWeights(times, 5);
      const Eigen::Matrix3Xd of_positions = weights * positions.middleRows(first, window);
      const Eigen::Matrix3Xd of_velocities = weights * velocities.middleRows(first, window);
      q.row(row) = of_positions.row(0);
      qd[0].row(row) = of_positions.row(1);
      qdd[0].row(row) = of_positions.row(2);
      qd[1].row(row) = of_velocities.row(0);
      qdd[1].row(row) = of_velocities.row(1);
    }
    for (int source = 0; source < 2; ++source)
      most = std::max(most, arm.explained(q, qd[source], qdd[source], from));
  }
  return most;
}

}  // namespace

void measureRecorded(const std::string& folder, const ReportRows& rows) {
  const RecordedArm arm(folder);
  const std::vector<double>& times = arm.motion().times;
  const double interval = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  StreamSpec spec;
  spec.group = "panda";
  spec.rate = static_cast<int>(std::lround(1 / interval));
  spec.quantum = 1e-6;
  spec.velocity = VelocityKind::kGood;
  const char* part = "";
  const auto add = [&](const char* method, double lag_ms, double value) {
    rows.add(part, spec, method, lag_ms, "vaf", value);
  };
  for (const double from : {0.0, kLearnt}) {
    part = from > 0 ? "recording_late" : "recording";
    add("default", -1, byCompletion(arm, true, from));
    add("default_positions_only", -1, byCompletion(arm, false, from));
    add("butterworth", -1, byButterworth(arm, interval, from));
    add("savitzky_golay", -1, bySavitzkyGolay(arm, interval, from));
    for (const double lag : kLags) add("node", 1e3 * lag, byNode(arm, lag, from));
  }
}

}  // namespace virtual_work_dynamics
