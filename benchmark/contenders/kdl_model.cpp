#include "contenders/kdl_model.h"

namespace virtual_work_dynamics {
namespace {

KDL::Rotation kdlRotation(const Matrix3l& R) {
  return {kdlVector(Vector3l(R.col(0))), kdlVector(Vector3l(R.col(1))),
          kdlVector(Vector3l(R.col(2)))};
}

KDL::Segment segmentOf(const Mechanism& mechanism, int index) {
  const Joint& joint = mechanism.joints()[index];
  const Link& link = mechanism.links()[index + 1];
  KDL::Joint kdl_joint(joint.name);
  if (joint.type != JointType::kFixed) {
    kdl_joint = KDL::Joint(
        joint.name, kdlVector(joint.p_PoKo_P), kdlVector(Vector3l(joint.R_PK * joint.axis_K)),
        joint.type == JointType::kPrismatic ? KDL::Joint::TransAxis : KDL::Joint::RotAxis);
  }
  const Eigen::Matrix3d I = link.inertia_Cm_K.cast<double>();
  return KDL::Segment(
      link.name, kdl_joint, KDL::Frame(kdlRotation(joint.R_PK), kdlVector(joint.p_PoKo_P)),
      KDL::RigidBodyInertia(
          static_cast<double>(link.mass), kdlVector(link.p_KoCm_K),
          KDL::RotationalInertia(I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2))));
}

}  // namespace

KDL::Vector kdlVector(const Vector3l& v) {
  return {static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())};
}

KDL::JntArray kdlArray(const Eigen::VectorXd& values) {
  KDL::JntArray array(static_cast<unsigned int>(values.size()));
  array.data = values;
  return array;
}

KDL::Chain kdlChain(const Mechanism& mechanism, const std::vector<int>& joints) {
  KDL::Chain chain;
  for (const int joint : joints) chain.addSegment(segmentOf(mechanism, joint));
  return chain;
}

KDL::Tree kdlTree(const Mechanism& mechanism) {
  KDL::Tree tree(mechanism.links()[0].name);
  for (std::size_t k = 0; k < mechanism.joints().size(); ++k) {
    const Link& parent = mechanism.links()[mechanism.joints()[k].parent_link];
    tree.addSegment(segmentOf(mechanism, static_cast<int>(k)), parent.name);
  }
  return tree;
}

}  // namespace virtual_work_dynamics
