#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "generated_program.h"
#include "virtual_work_dynamics/inverse_dynamics.h"

namespace virtual_work_dynamics {

/// A robot in a scene, and samples of all that its function reads.
struct GeneratedCase {
  Mechanism mechanism;
  Scene scene;
  Request request;
  double farthest;  // position, rad or m
};

inline GeneratedCase caseOf(const Mechanism& mechanism, const Scene& scene, bool child_axes) {
  GeneratedCase made{mechanism, scene, {}, 3};
  (child_axes ? made.request.child_axes : made.request.root_axes) =
      requestedReactions(mechanism, scene);
  return made;
}

inline std::vector<int> inputCounts(const GeneratedCase& of) {
  const int coordinates = static_cast<int>(of.mechanism.coordinates().size());
  std::vector<int> counts(3, coordinates);
  if (of.scene.root_moves) counts.push_back(RootState::kNumbers);
  const int orientations = static_cast<int>(of.mechanism.orientations());
  if (orientations > 0) counts.push_back(4 * orientations);
  const int wrenches = static_cast<int>(of.scene.applied_wrenches.size());
  if (wrenches > 0) counts.push_back(6 * wrenches);
  return counts;
}

inline std::vector<int> outputCounts(const GeneratedCase& of) {
  std::vector<int> counts;
  const auto add = [&](std::size_t count) {
    if (count > 0) counts.push_back(static_cast<int>(count));
  };
  add(of.request.efforts ? of.mechanism.coordinates().size() : 0);
  add(6 * of.request.child_axes.size());
  add(6 * of.request.root_axes.size());
  return counts;
}

template <typename Vector>
void append(std::vector<double>& numbers, const Vector& vector) {
  numbers.insert(numbers.end(), vector.data(), vector.data() + vector.size());
}

/// Makes a sample, appends it to `row`, and what the library computes of it to `results`.
inline void addSample(const GeneratedCase& of, const InverseDynamics& dynamics,
                      Workspace& workspace, std::mt19937& generator, std::vector<double>& row,
                      std::vector<double>& results) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto fill = [&](auto& vector, double size) {
    for (Eigen::Index i = 0; i < vector.size(); ++i) vector[i] = size * uniform(generator);
    append(row, vector);
  };
  Motion motion(dynamics.coordinates(), dynamics.orientations());
  fill(motion.q, of.farthest);
  fill(motion.qd, 3);
  fill(motion.qdd, 3);
  if (of.scene.root_moves) {
    motion.root.angular_velocity = Eigen::Vector3d(uniform(generator), 1, uniform(generator));
    motion.root.angular_acceleration = Eigen::Vector3d(2, uniform(generator), -1);
    motion.root.acceleration = Eigen::Vector3d(uniform(generator), 0.5, 3);
    const RootState state = dynamics.rootState(motion.root);
    row.insert(row.end(), state.data(), state.data() + RootState::kNumbers);
  }
  for (Eigen::Quaterniond& orientation : motion.orientations) {
    orientation = Eigen::Quaterniond(uniform(generator), uniform(generator), 1, 0.5).normalized();
    append(row, orientation.coeffs());
  }
  Load load(of.scene);
  for (Wrench& wrench : load.wrenches) {
    fill(wrench.force, 5);
    fill(wrench.torque, 5);
  }
  dynamics.compute(motion, load, workspace);
  append(results, workspace.effort());
  for (const auto* wrenches : {&workspace.childAxes(), &workspace.rootAxes()}) {
    for (const Wrench& wrench : *wrenches) {
      append(results, wrench.force);
      append(results, wrench.torque);
    }
  }
}

/// std::vector<double> that are not the same bits; the sign of a zero is free.
inline std::size_t differences(const std::vector<double>& made,
                               const std::vector<double>& expected) {
  if (made.size() != expected.size()) return std::max(made.size(), expected.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < made.size(); ++i) count += made[i] == expected[i] ? 0 : 1;
  return count;
}

/// Compiles and runs the code of a case, and counts results with other bits than the library's.
inline void expectSameBits(const GeneratedCase& of, const std::string& compiler,
                           const std::string& options, const GeneratedCodeOptions& how = {},
                           std::size_t samples = 203) {
  GeneratedProgram program(generateCode(of.mechanism, of.scene, of.request, how), how.name,
                           inputCounts(of), outputCounts(of));
  const InstructionSet set = comparedInstructions();
  ASSERT_EQ(program.compile(compiler, options + optionsFor(set)), "");
  const InverseDynamics dynamics(of.mechanism, of.scene, of.request, set);
  Workspace workspace = dynamics.makeWorkspace();
  std::mt19937 generator(11);
  std::vector<double> rows, expected;
  for (std::size_t i = 0; i < samples; ++i) {
    std::vector<double> results;
    addSample(of, dynamics, workspace, generator, rows, results);
    for (int twice = 0; twice < 2; ++twice) {
      expected.insert(expected.end(), results.begin(), results.end());
    }
  }
  EXPECT_EQ(differences(program.run(rows), expected), 0u) << "of " << expected.size();
}

/// gcc and clang, as far as they are there.
inline std::vector<std::string> compilers() {
  std::vector<std::string> all;
  if (isThere("gcc")) all.emplace_back("gcc");
  for (const char* const clang : {"clang", "clang-14"}) {
    if (!isThere(clang)) continue;
    all.emplace_back(clang);
    break;
  }
  return all;
}

inline Scene busyScene(const Mechanism& mechanism) {
  Scene scene;
  scene.gravity = {0.3, -1, -9.6};
  scene.root_moves = true;
  const std::string& last = mechanism.links().back().name;
  AppliedWrench wrench;
  wrench.link = last;
  wrench.at = {0.1, -0.2, 0.3};
  wrench.axes = Axes::kRoot;
  wrench.force = {1, 2, 3};
  scene.applied_wrenches.push_back(wrench);
  wrench.axes = Axes::kLink;
  scene.applied_wrenches.push_back(wrench);
  JointTerms terms;
  terms.joint = mechanism.joint(mechanism.coordinates().front()).name;
  terms.stiffness = 3;
  terms.rest = 0.4;
  terms.damping = 0.2;
  terms.coulomb = 0.7;
  terms.coulomb_velocity = 2;
  terms.rotor_inertia = 0.05;
  terms.offset = -0.6;
  scene.joints = {terms};
  return scene;
}

}  // namespace virtual_work_dynamics
