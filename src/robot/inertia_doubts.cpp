#include "robot/inertia_doubts.h"

#include <Eigen/Eigenvalues>
#include <cstdio>

#include "base/printable.h"

namespace virtual_work_dynamics {

namespace {

// Share of the trace by which moments may break an inequality, as descriptions are written with few
// digits.
constexpr long double kTolerance = 1e-9L;

std::string momentsText(Vector3l moments) {
  const long double rounding = kTolerance * moments.cwiseAbs().sum();
  moments = (moments.array().abs() < rounding).select(Vector3l::Zero(), moments);
  char text[96];
  std::snprintf(text, sizeof text, "%.6Lg, %.6Lg, %.6Lg kg m^2", moments[0], moments[1],
                moments[2]);
  return text;
}

void judgeTensor(const Link& link, std::vector<Doubt>& doubts) {
  const std::string why = impossibleInertia(link.inertia_Cm_K);
  if (!why.empty()) doubts.push_back({"link " + inQuotes(link.name) + ": " + why, true});
}

// A body is a movable joint's child link with everything welded to it.
void judgeMovingLeaves(const std::vector<Link>& links, const std::vector<Joint>& joints,
                       std::vector<Doubt>& doubts) {
  std::vector<int> body_of_link(links.size(), -1);  // joint that carries the link's body; -1: root
  std::vector<long double> mass(joints.size(), 0);
  std::vector<bool> leaf(joints.size(), true);
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const int parent_body = body_of_link[joints[k].parent_link];
    const bool moves = joints[k].coordinate >= 0;
    const int body = moves ? static_cast<int>(k) : parent_body;
    body_of_link[k + 1] = body;
    if (body >= 0) mass[body] += links[k + 1].mass;
    if (moves && parent_body >= 0) leaf[parent_body] = false;
  }
  for (std::size_t k = 0; k < joints.size(); ++k) {
    if (joints[k].coordinate >= 0 && leaf[k] && mass[k] == 0) {
      doubts.push_back({"link " + inQuotes(links[k + 1].name) + ": moved by joint " +
                            inQuotes(joints[k].name) + " but has no mass (0 kg)",
                        true});
    }
  }
}

}  // namespace

std::string impossibleInertia(const Matrix3l& inertia) {
  const Eigen::SelfAdjointEigenSolver<Matrix3l> solver(inertia, Eigen::EigenvaluesOnly);
  const Vector3l moments = solver.eigenvalues();  // ascending
  const long double slack = kTolerance * moments.cwiseAbs().sum();
  if (moments[0] < -slack) {
    return "negative principal moment of inertia (" + momentsText(moments) + ")";
  }
  if (moments[2] > moments[0] + moments[1] + slack) {
    return "principal moments of inertia break the triangle inequality (" + momentsText(moments) +
           ")";
  }
  return "";
}

std::vector<Doubt> inertiaDoubts(const std::vector<Link>& links, const std::vector<Joint>& joints) {
  std::vector<Doubt> doubts;
  for (const Link& link : links) judgeTensor(link, doubts);
  judgeMovingLeaves(links, joints, doubts);
  return doubts;
}

}  // namespace virtual_work_dynamics
