#include "offline/effort_comparison.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "base/printable.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kLongestLag = 0.25;     // s
constexpr double kShareOfTime = 0.125;   // of a recording, for lags in each direction
constexpr std::size_t kMostRows = 4096;  // that a scan looks at
constexpr int kSteps = 50;               // of a scan, in each direction
constexpr int kRounds = 3;               // of scans, each ten times as fine
constexpr double kFinerBy = 10;
constexpr double kCoulombVelocity = 0.02;  // rad/s or m/s, over which dry friction changes its sign
// How many standard deviations of what chance makes of it, more must be left at the ends of the
// scan than at the lag, or the motion does not show one.
constexpr double kShown = 5;

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

// A row of a recording by its time, read between rows on straight lines.
class Between {
 public:
  Between(const std::vector<double>& times, const std::vector<double>& values)
      : times_(times), values_(values) {}

  double operator()(double time) const {
    const auto later = std::upper_bound(times_.begin(), times_.end(), time);
    if (later == times_.begin()) return values_.front();
    if (later == times_.end()) return values_.back();
    const auto i = static_cast<std::size_t>(later - times_.begin());
    const double share = (time - times_[i - 1]) / (times_[i] - times_[i - 1]);
    return values_[i - 1] + share * (values_[i] - values_[i - 1]);
  }

 private:
  const std::vector<double>& times_;
  const std::vector<double>& values_;
};

// What is left of measured efforts when computed ones, and friction, of a lag before are fitted to
// them, in the rows that have such at every lag of the scan. It is the computed ones that are read
// between rows, as straight lines between noisy values have less noise than the values.
class LagScan {
 public:
  explicit LagScan(const ComparedEfforts& efforts)
      : computed_(efforts.times, efforts.computed),
        velocity_(efforts.times, efforts.velocities),
        longest_(
            std::min(kLongestLag, kShareOfTime * (efforts.times.back() - efforts.times.front()))) {
    const std::vector<double>& times = efforts.times;
    std::vector<double> measured;
    const std::size_t stride = times.size() / kMostRows + 1;
    for (std::size_t row = 0; row < times.size(); row += stride) {
      const bool inside =
          times[row] - longest_ >= times.front() && times[row] + longest_ <= times.back();
      if (!inside) continue;
      times_.push_back(times[row]);
      measured.push_back(efforts.measured[row]);
    }
    measured_ =
        Eigen::Map<Eigen::VectorXd>(measured.data(), static_cast<Eigen::Index>(measured.size()));
  }

  double longest() const { return longest_; }
  bool possible() const { return times_.size() > kFitted; }

  Eigen::VectorXd rest(double lag) const {
    Eigen::MatrixXd basis(measured_.size(), Eigen::Index{kFitted});
    for (Eigen::Index i = 0; i < basis.rows(); ++i) {
      const double time = times_[static_cast<std::size_t>(i)] - lag;
      const double velocity = velocity_(time);
      basis.row(i) << computed_(time), velocity, std::tanh(velocity / kCoulombVelocity), 1;
    }
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(basis);
    return measured_ - basis * factors.solve(measured_);
  }
  double left(double lag) const { return rest(lag).squaredNorm(); }

  // Standard deviation of the lag that leaves least, or nothing where it is not shown: by the
  // variance of what is left, of which so many values count as independent as it has times of
  // correlation, and by how fast more is left beside it.
  std::optional<double> deviation(double lag, double step) const {
    const Eigen::VectorXd values = rest(lag);
    const double least = values.squaredNorm();
    const double curvature = (left(lag - step) - 2 * least + left(lag + step)) / (step * step);
    const double more = std::min(left(-longest_), left(longest_)) - least;
    double correlated = 1;
    for (Eigen::Index shift = 1; shift < values.size(); ++shift) {
      const Eigen::Index count = values.size() - shift;
      const double product = values.head(count).dot(values.tail(count));
      if (!(product > 0)) break;
      correlated += 2 * product / least;
    }
    const double variance = least * correlated / static_cast<double>(values.size());
    if (!(curvature > 0) || !(more > kShown * kShown * variance)) return std::nullopt;
    return std::sqrt(2 * variance / curvature);
  }

 private:
  static constexpr int kFitted = 4;  // numbers

  const Between computed_, velocity_;
  const double longest_;
  std::vector<double> times_;
  Eigen::VectorXd measured_;
};

void findLag(const ComparedEfforts& efforts, EffortComparison& comparison) {
  const auto notLater = [](double a, double b) { return !(b > a); };
  const std::vector<double>& times = efforts.times;
  if (std::adjacent_find(times.begin(), times.end(), notLater) != times.end()) return;
  const LagScan scan(efforts);
  if (!scan.possible()) return;
  double best = 0, least = std::numeric_limits<double>::infinity();
  double step = scan.longest() / kSteps;
  int steps = kSteps;
  for (int round = 0; round < kRounds; ++round) {
    const double middle = best;
    for (int i = -steps; i <= steps; ++i) {
      const double lag = middle + i * step;
      if (std::abs(lag) > scan.longest()) continue;
      const double left = scan.left(lag);
      if (left >= least) continue;
      least = left;
      best = lag;
    }
    steps = static_cast<int>(kFinerBy);
    step /= kFinerBy;
  }
  const double coarse = scan.longest() / kSteps;
  if (std::abs(best) > scan.longest() - coarse) return;
  const auto deviation = scan.deviation(best, coarse);
  if (!deviation) return;
  comparison.lag = best;
  comparison.lag_deviation = *deviation;
}

std::string cell(const char* format, double value) {
  constexpr std::size_t kLongest = 32;
  char text[kLongest];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string padded(const std::string& text, std::size_t width, bool left) {
  const std::string blanks(text.size() < width ? width - text.size() : 0, ' ');
  return left ? text + blanks : blanks + text;
}

}  // namespace

EffortComparison compare(const ComparedEfforts& efforts) {
  EffortComparison comparison;
  comparison.rows = efforts.times.size();
  if (comparison.rows == 0) return comparison;
  const double measured_mean = mean(efforts.measured);
  comparison.bias = mean(efforts.computed) - measured_mean;
  double squares = 0, variance = 0, left = 0;
  for (std::size_t i = 0; i < comparison.rows; ++i) {
    const double residual = efforts.computed[i] - efforts.measured[i];
    squares += residual * residual;
    left += (residual - comparison.bias) * (residual - comparison.bias);
    variance += (efforts.measured[i] - measured_mean) * (efforts.measured[i] - measured_mean);
  }
  comparison.rms = std::sqrt(squares / static_cast<double>(comparison.rows));
  // Roundings of a constant make no variance.
  const double rounding = std::numeric_limits<double>::epsilon() * measured_mean;
  if (variance > 100 * rounding * rounding * static_cast<double>(comparison.rows)) {
    comparison.vaf = 1 - left / variance;
    findLag(efforts, comparison);
  }
  return comparison;
}

std::string comparisonTable(const std::vector<ComparedEfforts>& joints) {
  constexpr std::size_t kColumn = 12;
  std::size_t widest = std::string("joint").size();
  for (const ComparedEfforts& joint : joints) {
    widest = std::max(widest, shortened(joint.joint).size());
  }
  std::string text = "  " + padded("joint", widest, true);
  for (const char* head : {"rows", "VAF", "rms", "bias"}) text += padded(head, kColumn, false);
  text += "       " + padded("lag (ms)", kColumn, false) + padded("+-", kColumn - 4, false) + "\n";
  for (const ComparedEfforts& joint : joints) {
    const EffortComparison found = compare(joint);
    text += "  " + padded(shortened(joint.joint), widest, true) +
            padded(std::to_string(found.rows), kColumn, false) +
            padded(found.vaf ? cell("%.4f", *found.vaf) : "-", kColumn, false) +
            padded(cell("%.4g", found.rms), kColumn, false) +
            padded(cell("%.4g", found.bias), kColumn, false) + "  " + padded(joint.unit, 5, true) +
            padded(found.lag ? cell("%.1f", *found.lag * 1000) : "-", kColumn, false) +
            padded(found.lag ? cell("%.1f", found.lag_deviation * 1000) : "-", kColumn - 4, false) +
            "\n";
  }
  return text;
}

}  // namespace virtual_work_dynamics
