#include "ros/cross_check.h"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace virtual_work_dynamics {
namespace {

// Time after which a waiting sample is looked for: the computing thread does not wake this one.
constexpr std::chrono::milliseconds kPoll{20};

// Sums below this lose digits to denormal numbers; differences are then relative to this.
constexpr double kSmallestSum =
    std::numeric_limits<double>::min() / std::numeric_limits<double>::epsilon();

// With closed loops efforts are compared even if nobody listens to them.
Request comparedRequest(const Dynamics& plan) {
  Request request = plan.treeRequest();
  request.efforts = request.efforts || plan.closed();
  return request;
}

double relative(double difference, double sum) {
  if (!std::isfinite(difference) || !std::isfinite(sum)) {
    return std::numeric_limits<double>::infinity();
  }
  return difference / std::max(sum, kSmallestSum);
}

// Norms that neither overflow nor underflow ignore NaN, so NaN is tested for first.
double distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d difference = a - b;
  return difference.allFinite() ? difference.stableNorm() : std::numeric_limits<double>::infinity();
}

void keepLarger(double value, const char* what, const std::string& name,
                CrossCheckSlot::Finding& finding) {
  if (!finding.where.empty() && value <= finding.largest) return;
  finding.largest = value;
  finding.where = what + name;
}

// Lets everything else that wants the processor go first, also when the node was started with a
// real-time priority, which threads inherit. Where the system refuses, priorities stay equal.
void yieldToOthers() {
#ifdef SCHED_IDLE
  sched_param none{};
  pthread_setschedparam(pthread_self(), SCHED_IDLE, &none);
#endif
}

}  // namespace

CrossCheckSlot::CrossCheckSlot(const Mechanism& mechanism, const Dynamics& plan)
    : coordinates_(mechanism.coordinateNames()),
      child_compared_(comparedOf(mechanism, plan.request().child_axes)),
      root_compared_(comparedOf(mechanism, plan.request().root_axes)),
      closed_(plan.closed()),
      lagrange_(mechanism, plan.tree(), comparedRequest(plan)),
      bound_(mechanism, plan.tree()),
      motion_(lagrange_.coordinates()),
      effort_(lagrange_.request().efforts ? lagrange_.coordinates() : 0),
      child_axes_(plan.request().child_axes.size()),
      root_axes_(plan.request().root_axes.size()),
      load_(plan.tree()) {}

std::vector<CrossCheckSlot::Compared> CrossCheckSlot::comparedOf(
    const Mechanism& mechanism, const std::vector<std::string>& joints) {
  std::vector<Compared> compared;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const int index = joints[i] == kGround ? -1 : mechanism.reactionIndex(joints[i]);
    if (index < 0 && joints[i] != kGround) continue;  // a closure
    compared.push_back({i, static_cast<std::size_t>(index + 1)});
  }
  return compared;
}

bool CrossCheckSlot::offer(const Motion& motion, const Load& load, const Results& results) {
  State state = state_.load(std::memory_order_relaxed);
  if (state == State::kChecking) return false;
  if (state == State::kEmpty) offered_ = 0;
  // If the n-th sample replaces the one before with probability 1/n, all are equally likely.
  ++offered_;
  if (state == State::kFull && random_() % offered_ != 0) return false;
  if (!state_.compare_exchange_strong(state, State::kWriting, std::memory_order_acquire)) {
    return false;
  }
  motion_ = motion;
  effort_ = results.treeEffort(effort_.size());
  child_axes_ = results.child_axes;
  root_axes_ = results.root_axes;
  load_.wrenches = closed_ ? results.loops.tree_wrenches : load.wrenches;
  state_.store(State::kFull, std::memory_order_release);
  return true;
}

std::optional<CrossCheckSlot::Finding> CrossCheckSlot::check() {
  State state = State::kFull;
  if (!state_.compare_exchange_strong(state, State::kChecking, std::memory_order_acquire)) {
    return std::nullopt;
  }
  lagrange_.compute(motion_, load_);
  bound_.compute(motion_, load_);
  const Request& request = lagrange_.request();
  Finding finding;
  compareEfforts(finding);
  compareWrenches(child_axes_, lagrange_.childAxes(), request.child_axes, child_compared_, finding);
  compareWrenches(root_axes_, lagrange_.rootAxes(), request.root_axes, root_compared_, finding);
  state_.store(State::kEmpty, std::memory_order_release);
  return finding;
}

void CrossCheckSlot::compareEfforts(Finding& finding) const {
  for (Eigen::Index i = 0; i < effort_.size(); ++i) {
    const auto place = static_cast<std::size_t>(i);
    const double difference = std::abs(effort_[i] - lagrange_.effort()[i]);
    keepLarger(relative(difference, bound_.efforts()[place]), "effort of ", coordinates_[place],
               finding);
  }
}

void CrossCheckSlot::compareWrenches(const std::vector<Wrench>& results,
                                     const std::vector<Wrench>& others,
                                     const std::vector<std::string>& joints,
                                     const std::vector<Compared>& compared,
                                     Finding& finding) const {
  for (std::size_t i = 0; i < compared.size(); ++i) {
    const WrenchMagnitude& sum = bound_.wrenches()[compared[i].magnitude];
    const Wrench& result = results[compared[i].result];
    const double force = distance(result.force, others[i].force);
    const double moment = distance(result.torque, others[i].torque);
    keepLarger(relative(force, sum.force), "force at ", joints[i], finding);
    // About a point of its own a moment may be larger than the terms of that about the origin.
    const double moment_sum = std::max(sum.moment, result.torque.stableNorm());
    keepLarger(relative(moment, moment_sum), "moment at ", joints[i], finding);
  }
}

CrossCheck::CrossCheck(double rate)
    : period_(std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / rate))),
      thread_([this] { run(); }) {}

CrossCheck::~CrossCheck() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void CrossCheck::watch(std::shared_ptr<CrossCheckSlot> slot) {
  // The replaced slot is deleted outside the lock, by its last owner.
  const std::lock_guard<std::mutex> lock(mutex_);
  slot_.swap(slot);
}

CrossCheck::Report CrossCheck::takeReport() {
  const std::lock_guard<std::mutex> lock(mutex_);
  Report report = report_;
  report_ = Report();
  report_.done = report.done;
  return report;
}

void CrossCheck::run() {
  yieldToOthers();
  const auto poll = std::min<Clock::duration>(period_, kPoll);
  std::unique_lock<std::mutex> lock(mutex_);
  Clock::time_point next = Clock::now();
  while (!changed_.wait_until(lock, next, [this] { return stopping_; })) {
    const Clock::time_point now = Clock::now();
    next = now + poll;
    if (!slot_ || !slot_->full()) continue;
    std::shared_ptr<CrossCheckSlot> slot = slot_;
    lock.unlock();
    const std::optional<CrossCheckSlot::Finding> finding = slot->check();
    slot.reset();
    lock.lock();
    if (!finding) continue;
    next = now + period_;
    ++report_.done;
    if (!report_.news || finding->largest > report_.finding.largest) report_.finding = *finding;
    report_.news = true;
  }
}

}  // namespace virtual_work_dynamics
