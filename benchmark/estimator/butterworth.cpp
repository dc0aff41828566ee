#include "estimator/butterworth.h"

#include <algorithm>
#include <cmath>

namespace virtual_work_dynamics {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr Eigen::Index kPadding = 200;  // rows, mirrored at the ends

/// One section by the bilinear transform.
struct Section {
  double b;       // numerator b (1 + z^-1)^2
  double a1, a2;  // denominator 1 + a1 z^-1 + a2 z^-2

  Section(double cutoff, double damping) {
    const double w = std::tan(kPi * cutoff);
    const double scale = 1 / (1 + 2 * damping * w + w * w);
    b = w * w * scale;
    a1 = 2 * (w * w - 1) * scale;
    a2 = (1 - 2 * damping * w + w * w) * scale;
  }

  /// Starts in the steady state of the first value.
  void filter(Eigen::Ref<Eigen::VectorXd> x) const {
    double x1 = x[0], x2 = x[0], y1 = x[0], y2 = x[0];
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const double in = x[i];
      const double out = b * (in + 2 * x1 + x2) - a1 * y1 - a2 * y2;
      x2 = x1;
      x1 = in;
      y2 = y1;
      y1 = out;
      x[i] = out;
    }
  }
};

}  // namespace

Eigen::MatrixXd zeroPhaseLowPass(const Eigen::MatrixXd& samples, double cutoff, int order) {
  const Eigen::Index rows = samples.rows();
  const Eigen::Index pad = std::min(kPadding, rows - 1);
  Eigen::MatrixXd filtered(rows, samples.cols());
  for (Eigen::Index column = 0; column < samples.cols(); ++column) {
    const auto x = samples.col(column);
    Eigen::VectorXd padded(rows + 2 * pad);
    padded.segment(pad, rows) = x;
    for (Eigen::Index i = 1; i <= pad; ++i) {
      padded[pad - i] = 2 * x[0] - x[i];
      padded[pad + rows - 1 + i] = 2 * x[rows - 1] - x[rows - 1 - i];
    }
    for (int pass = 0; pass < 2; ++pass) {
      for (int section = 0; section < order / 2; ++section)
        Section(cutoff, std::sin(kPi * (2 * section + 1) / (2 * order))).filter(padded);
      padded.reverseInPlace();
    }
    filtered.col(column) = padded.segment(pad, rows);
  }
  return filtered;
}

Eigen::MatrixXd gradient(const Eigen::MatrixXd& samples, double interval) {
  const Eigen::Index rows = samples.rows();
  Eigen::MatrixXd slopes(rows, samples.cols());
  slopes.middleRows(1, rows - 2) =
      (samples.bottomRows(rows - 2) - samples.topRows(rows - 2)) / (2 * interval);
  slopes.row(0) = (samples.row(1) - samples.row(0)) / interval;
  slopes.row(rows - 1) = (samples.row(rows - 1) - samples.row(rows - 2)) / interval;
  return slopes;
}

}  // namespace virtual_work_dynamics
