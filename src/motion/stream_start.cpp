#include "motion/stream_start.h"

#include <Eigen/QR>

namespace virtual_work_dynamics {

StartFit::StartFit(int rows, int terms)
    : powers_(rows, terms), values_(rows), coefficients_(terms), inverse_(terms, terms) {}

void StartFit::set(int row, double t, double value) {
  double power = 1;
  for (Eigen::Index i = 0; i < powers_.cols(); ++i) powers_(row, i) = power *= t;
  values_[row] = value;
}

void StartFit::solve() {
  const Eigen::Index terms = powers_.cols();
  const auto qr = powers_.householderQr();
  coefficients_ = qr.solve(values_);
  inverse_ = qr.matrixQR()
                 .topLeftCorner(terms, terms)
                 .triangularView<Eigen::Upper>()
                 .solve(decltype(inverse_)::Identity(terms, terms));
}

}  // namespace virtual_work_dynamics
