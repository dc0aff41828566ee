#include "loops/given_loops.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "base/number_text.h"
#include "base/printable.h"
#include "loops/driven_conditions.h"

namespace virtual_work_dynamics {

namespace {

// What is open by less, m or rad, counts as closed, so that the position or the rates are at fault.
constexpr double kClosedTogether = 1e-9;

}  // namespace

GivenLoops::GivenLoops(const Mechanism& mechanism, const LoopKinematics& loops,
                       const std::vector<std::string>& closure_names, const Given& given,
                       double rank_tolerance, double length)
    : closure_names_(closure_names),
      given_(given),
      kinematics_(placed(mechanism, loops, closure_names, given)),
      completion_(mechanism, kinematics_, loopGroups(mechanism, kinematics_), rank_tolerance,
                  length) {}

LoopKinematics GivenLoops::placed(const Mechanism& mechanism, const LoopKinematics& loops,
                                  const std::vector<std::string>& closure_names,
                                  const Given& given) {
  LoopKinematics kinematics(mechanism, setsOf(mechanism, loops, closure_names, given));
  kinematics.driven() = Motion(static_cast<Eigen::Index>(given.drivenNumbers()));
  kinematics.setPosition(loops.position());
  kinematics.adoptConstants();
  kinematics.setPosition(loops.position());
  return kinematics;
}

ConditionSets GivenLoops::setsOf(const Mechanism& mechanism, const LoopKinematics& loops,
                                 const std::vector<std::string>& closure_names,
                                 const Given& given) {
  ConditionSets sets = loops.conditionSets();
  Eigen::Index number = 0;
  for (const std::size_t c : given.closures) {
    sets.push_back(std::make_shared<FreeAxisDrive>(closure_names[c], loops.closure(c), number++));
  }
  for (const int link : given.links) {
    sets.push_back(std::make_shared<PoseDrive>(mechanism, link, number));
    number += static_cast<Eigen::Index>(Given::kPoseNumbers);
  }
  return sets;
}

bool GivenLoops::complete(Motion& motion, const Motion& driven) {
  kinematics_.driven() = driven;
  kinematics_.setOrientations(motion.orientations);
  return completion_.complete(kinematics_, motion, given_.coordinates,
                              LoopCompletion::kFromCloseBy);
}

bool GivenLoops::determine(const Eigen::VectorXd& q) {
  kinematics_.setPosition(q);
  return completion_.determine(kinematics_, given_.coordinates);
}

Eigen::Index GivenLoops::freedom(const Eigen::VectorXd& q, const std::vector<bool>& given) {
  kinematics_.setPosition(q);
  return std::count(given.begin(), given.end(), false) - completion_.rank(kinematics_, given);
}

Eigen::Index GivenLoops::freedomOfRates(const Eigen::VectorXd& q, const std::vector<bool>& given) {
  kinematics_.setPosition(q);
  return std::count(given.begin(), given.end(), false) -
         completion_.rankOfRates(kinematics_, given);
}

std::vector<std::size_t> GivenLoops::undetermined(const Eigen::VectorXd& q) {
  std::vector<std::size_t> found;
  std::vector<bool> given = given_.coordinates;
  const Eigen::Index all = freedom(q, given);
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (given_.coordinates[i]) continue;
    // The conditions tell nothing of it when giving it takes a freedom away.
    given[i] = true;
    if (freedom(q, given) < all) found.push_back(i);
    given[i] = false;
  }
  return found;
}

void GivenLoops::getDriven(const Eigen::VectorXd& q, Eigen::Ref<Eigen::VectorXd> numbers) {
  kinematics_.setPosition(q);
  Eigen::Index number = 0;
  for (const std::size_t c : given_.closures) numbers[number++] = kinematics_.freePosition(c);
  for (const int link : given_.links) {
    numbers.segment<3>(number) = kinematics_.originOf(link);
    numbers.segment<4>(number + 3) = Eigen::Quaterniond(kinematics_.axesOf(link)).coeffs();
    number += static_cast<Eigen::Index>(Given::kPoseNumbers);
  }
}

std::string GivenLoops::whyOpen(const Eigen::VectorXd& q) {
  kinematics_.setPosition(q);
  double open = 0;
  std::size_t worst = 0;
  for (std::size_t s = 0; s < kinematics_.sets(); ++s) {
    const LoopKinematics::Norms norms = kinematics_.normsOf(s, kinematics_.phi());
    const double amount = std::max(norms.lengths, norms.directions);
    if (amount <= open) continue;
    open = amount;
    worst = s;
  }
  if (open <= kClosedTogether * std::max(1.0, completion_.length())) {
    return determine(q) ? kContradiction : kSingularPosition;
  }
  const bool closure = worst < closure_names_.size();
  return "the loops cannot be closed: " +
         (closure ? "closure " + inQuotes(closure_names_[worst]) : kinematics_.set(worst).place()) +
         " stays open by " + numberText(open) + " m or rad";
}

}  // namespace virtual_work_dynamics
