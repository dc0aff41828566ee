#include "contenders/peer_input.h"

namespace virtual_work_dynamics {
namespace {

// Adds to `sum` a link that is welded to it at the given pose.
void weld(Link& sum, const Link& link, const Matrix3l& R, const Vector3l& p) {
  const long double mass = sum.mass + link.mass;
  const Vector3l c = p + R * link.p_KoCm_K;
  const Vector3l c_sum =
      mass > 0 ? Vector3l((sum.mass * sum.p_KoCm_K + link.mass * c) / mass) : sum.p_KoCm_K;
  const auto carried = [&](const Matrix3l& inertia, long double m, const Vector3l& from) {
    const Vector3l d = from - c_sum;
    return Matrix3l(inertia + m * (d.dot(d) * Matrix3l::Identity() - d * d.transpose()));
  };
  sum.inertia_Cm_K = carried(sum.inertia_Cm_K, sum.mass, sum.p_KoCm_K) +
                     carried(R * link.inertia_Cm_K * R.transpose(), link.mass, c);
  sum.p_KoCm_K = c_sum;
  sum.mass = mass;
}

bool isMassless(const Link& link) {
  return link.mass == 0 && link.inertia_Cm_K.isZero(0);
}

}  // namespace

std::vector<int> movableJoints(const Mechanism& mechanism) {
  std::vector<int> movable;
  for (std::size_t k = 0; k < mechanism.joints().size(); ++k) {
    if (mechanism.joints()[k].type != JointType::kFixed) movable.push_back(static_cast<int>(k));
  }
  return movable;
}

std::vector<Motion> jointMotions(const Mechanism& mechanism, const std::vector<Motion>& motions,
                                 const std::vector<int>& joints) {
  std::vector<Motion> result;
  for (const Motion& motion : motions) {
    result.emplace_back(static_cast<Eigen::Index>(joints.size()));
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const Joint& joint = mechanism.joints()[joints[i]];
      result.back().q[i] = joint.multiplier * motion.q[joint.coordinate] + joint.offset;
      result.back().qd[i] = joint.multiplier * motion.qd[joint.coordinate];
      result.back().qdd[i] = joint.multiplier * motion.qdd[joint.coordinate];
    }
  }
  return result;
}

std::vector<long double> coordinateEfforts(const Mechanism& mechanism,
                                           const std::vector<int>& joints,
                                           const Eigen::VectorXd& joint_efforts) {
  std::vector<long double> efforts(mechanism.coordinates().size(), 0);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const Joint& joint = mechanism.joints()[joints[i]];
    efforts[joint.coordinate] += joint.multiplier * joint_efforts[i];
  }
  return efforts;
}

Mechanism withoutFixedJoints(const Mechanism& mechanism) {
  struct Place {
    int link = 0;  // of the result
    Matrix3l R = Matrix3l::Identity();
    Vector3l p = Vector3l::Zero();
  };
  std::vector<Place> places(mechanism.links().size());
  std::vector<Link> links{mechanism.links()[0]};
  std::vector<Joint> joints;
  for (std::size_t k = 0; k < mechanism.joints().size(); ++k) {
    Joint joint = mechanism.joints()[k];
    const Link& child = mechanism.links()[k + 1];
    const Place& parent = places[joint.parent_link];
    const Matrix3l R = parent.R * joint.R_PK;
    const Vector3l p = parent.p + parent.R * joint.p_PoKo_P;
    if (joint.type == JointType::kFixed) {
      places[k + 1] = {parent.link, R, p};
      weld(links[parent.link], child, R, p);
      continue;
    }
    joint.parent_link = parent.link;
    joint.child_link = static_cast<int>(links.size());
    joint.R_PK = R;
    joint.p_PoKo_P = p;
    places[k + 1].link = joint.child_link;
    links.push_back(child);
    links.back().parent_joint = static_cast<int>(joints.size());
    joints.push_back(joint);
  }
  return Mechanism(mechanism.name(), std::move(links), std::move(joints));
}

std::vector<int> serialPath(const Mechanism& mechanism) {
  const std::vector<Joint>& joints = mechanism.joints();
  // Whether a link, or anything it carries, moves on its parent or has mass.
  std::vector<bool> matters(mechanism.links().size(), false);
  for (std::size_t k = joints.size(); k-- > 0;) {
    if (joints[k].type != JointType::kFixed || !isMassless(mechanism.links()[k + 1])) {
      matters[k + 1] = true;
    }
    if (matters[k + 1]) matters[joints[k].parent_link] = true;
  }
  std::vector<int> path;
  int link = 0;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    if (joints[k].parent_link == link && matters[k + 1]) {
      path.push_back(static_cast<int>(k));
      link = static_cast<int>(k) + 1;
    } else if (matters[k + 1]) {
      return {};
    }
  }
  // Frames without mass at the tip, as of a flange.
  for (std::size_t k = 0; k < joints.size() && !path.empty(); ++k) {
    if (joints[k].parent_link != link) continue;
    path.push_back(static_cast<int>(k));
    link = static_cast<int>(k) + 1;
  }
  return path;
}

}  // namespace virtual_work_dynamics
