#include <algorithm>
#include <cmath>
#include <limits>

#include "loops/completion.h"

namespace virtual_work_dynamics {

namespace {

// How often a step is halved when the loops are closed to the rank's tolerance: near singular
// positions half a step often helps, and where frames fit no better none does.
constexpr int kHalvingsWhenClosed = 4;
// Misfit over the length below which a loop counts as closed, as it also does below the rank's
// tolerance. Newton's method goes on until rounding stops it or is all that is left of each
// condition.
constexpr double kClosed = 1e-12;
// Misfit, over that which is exact, at which a step that was to be the last one ends the search:
// what it leaves is expected to the second order only, and another step makes sure.
constexpr double kSettled = 4;
// Longest step, rad or of the length, so that an almost singular position does not cause a jump.
constexpr double kLongestStep = 0.5;
// Longest step that is bent, and longest bend over its step: further off, the conditions are not
// their first two derivatives.
constexpr double kLongestBent = 0.1;
constexpr double kMostBent = 0.25;
// Longest step, rad or of the length, after which rates are refined from the factorization before
// it: once, to the square of the step.
constexpr double kCloseBy = 1e-7;

constexpr double kUnknown = std::numeric_limits<double>::infinity();

}  // namespace

double LoopCompletion::misfit(const LoopKinematics& kinematics) const {
  double sum = 0;
  for (Eigen::Index i = 0; i < kinematics.conditions(); ++i) {
    const double scaled = position_scales_[i] * kinematics.phi()[i];
    sum += scaled * scaled;
  }
  return std::sqrt(sum);
}

// Solves A_p u = -conditions by the latest factorizations for all groups; returns the largest
// entry of coordinates that bend, rad or over the length. Those of a group are shortened to
// `longest`.
double LoopCompletion::solveSteps(const Eigen::VectorXd& conditions, double longest,
                                  Eigen::VectorXd& step) {
  double largest = 0;
  for (System& system : systems_) {
    setRight(system, conditions);
    solve(system);
    const double* const found = found_.data();
    double own = 0;
    for (const System::Found& of : system.found) {
      if (of.bends) own = std::max(own, std::abs(found[of.place]));
    }
    const double damping = own > longest ? longest / own : 1;
    for (const System::Found& of : system.found) {
      step.data()[of.coordinate] = damping * of.scale * found[of.place];
    }
    largest = std::max(largest, damping * own);
  }
  return largest;
}

// A step s leaves H[s, s] / 2 of the conditions, where H holds their second derivatives; so
// c = -A_p^-1 H[s, s] / 2 bends the way to them. Computes c; returns its length over that of s, or
// zero where the step is not to be bent.
double LoopCompletion::bendStep(LoopKinematics& kinematics) {
  if (step_length_ > kLongestBent || kinematics.drives()) return 0;
  kinematics.setVelocity(step_);
  const double bend = solveSteps(kinematics.turning(), kUnknown, bend_) / 2;
  return bend > 0 && bend <= kMostBent * step_length_ ? bend / step_length_ : 0;
}

// Goes the step, or as much of it as lessens the misfit; returns the misfit there.
double LoopCompletion::tryStep(LoopKinematics& kinematics, const Eigen::VectorXd& q, double now,
                               bool bent, int halvings) {
  double then = now;
  share_ = 1;
  for (int halving = 0; halving < halvings; ++halving, share_ /= 2) {
    tried_ = q + share_ * step_;
    if (bent) tried_ += (share_ * share_ / 2) * bend_;
    kinematics.setPosition(tried_);
    then = misfit(kinematics);
    if (then < now || now <= rounding_) break;
  }
  return then;
}

// What another step by the same factorization leaves of the misfit is H[s, .], or 2 |c| / |s|; it
// tells whether another factorization can be spared. What a step s' by a new one leaves, over s',
// is about |c| / |s|^2; it tells whether it needs to be bent.
bool LoopCompletion::close(LoopKinematics& kinematics, Eigen::VectorXd& q,
                           const std::vector<bool>& given, const Search& search) {
  want(given);
  close_by_ = false;
  kinematics.setPosition(q);
  double now = misfit(kinematics);
  const double closed = std::max(kClosed, rank_tolerance_);
  double left = kUnknown, curvature = 1;
  for (steps_ = 0; steps_ < search.most_steps && now > exact_ && std::isfinite(now); ++steps_) {
    const bool again = left * now <= exact_;
    if (!again) factorize(kinematics, position_scales_);
    step_length_ = solveSteps(kinematics.phi(), kLongestStep, step_);
    const bool fresh = !again && sound();
    double bend = 0;
    if (fresh && curvature * step_length_ * now > exact_) bend = bendStep(kinematics);
    const double share = again ? left : bend > 0 ? 2 * bend * bend : curvature * step_length_;
    const bool last = (again || fresh) && share * now <= exact_;  // more finds but rounding errors
    const int halvings = now <= closed ? kHalvingsWhenClosed : search.most_halvings;
    const double then = tryStep(kinematics, q, now, bend > 0, halvings);
    if (!(then < now)) {
      kinematics.setPosition(q);
      close_by_ = close_by_ || fresh;
      break;
    }
    q = tried_;
    left = kUnknown;
    if (fresh && share_ == 1) {
      if (bend == 0) bend = then / now;
      left = 2 * bend;
      if (step_length_ > 0) curvature = bend / step_length_;
    }
    if (!again) close_by_ = left < kUnknown && step_length_ <= kCloseBy;
    const bool stalled = then > search.stalled * now && then > closed;
    now = then;
    if (stalled || (last && now <= kSettled * exact_)) break;
  }
  return now <= closed;
}

}  // namespace virtual_work_dynamics
