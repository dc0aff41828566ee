#include "stability/mechanism_maker.h"

#include <Eigen/Geometry>

namespace virtual_work_dynamics {

MechanismMaker::MechanismMaker(std::uint32_t seed) : random_(seed), links_(1) {
  links_[0].name = "base";
}

Vector3l MechanismMaker::direction() {
  Vector3l v;
  do {
    const double x = random_.uniform(-1, 1), y = random_.uniform(-1, 1);
    v << x, y, random_.uniform(-1, 1);
  } while (v.norm() < 0.1L || v.norm() > 1);
  return v.normalized();
}

Matrix3l MechanismMaker::rotation() {
  const Vector3l axis = direction();
  return Eigen::AngleAxis<long double>(random_.uniform(0.3, 2.8), axis).toRotationMatrix();
}

JointPlace MechanismMaker::anyPlace(JointType type, double distance) {
  const Vector3l axis = direction();
  const Matrix3l R = rotation();
  return {type, axis, R, distance * direction()};
}

Link MechanismMaker::cuboid(double mass, double length) {
  Link link;
  link.mass = mass;
  link.p_KoCm_K = length / 2 * direction();
  const double a = length * random_.uniform(0.1, 0.5), b = length * random_.uniform(0.1, 0.5);
  const Vector3l squares{a * a, b * b, length * length};
  const Matrix3l R = rotation();
  const Matrix3l second = link.mass / 12 * R * squares.asDiagonal() * R.transpose();
  link.inertia_Cm_K = second.trace() * Matrix3l::Identity() - second;
  return link;
}

Link MechanismMaker::roundBody(double mass, const Vector3l& centre, const Vector3l& axis,
                               double axial, double transverse) {
  Link link;
  link.mass = mass;
  link.p_KoCm_K = centre;
  link.inertia_Cm_K = static_cast<long double>(transverse) * Matrix3l::Identity() +
                      (static_cast<long double>(axial) - transverse) * axis * axis.transpose();
  return link;
}

int MechanismMaker::add(int parent_link, const JointPlace& place, const Link& body) {
  const int k = static_cast<int>(joints_.size());
  Joint joint;
  joint.name = "joint_" + std::to_string(k + 1);
  joint.type = place.type;
  joint.parent_link = parent_link;
  joint.child_link = k + 1;
  joint.p_PoKo_P = place.p_PoKo_P;
  joint.R_PK = place.R_PK;
  if (place.type != JointType::kFixed) {
    joint.axis_K = place.axis_K;
    joint.coordinate = coordinates_++;
  }
  joints_.push_back(joint);
  links_.push_back(body);
  links_.back().name = "link_" + std::to_string(k + 1);
  links_.back().parent_joint = k;
  return k + 1;
}

void MechanismMaker::mimic(int coordinate, double multiplier, double offset) {
  Joint& joint = joints_.back();
  joint.mimics = true;
  joint.coordinate = coordinate;
  joint.multiplier = multiplier;
  joint.offset = offset;
  --coordinates_;
}

Mechanism MechanismMaker::mechanism(const std::string& name) const {
  return Mechanism(name, links_, joints_);
}

JointType mixedType(int index) {
  return index % 3 == 2 ? JointType::kPrismatic : JointType::kRevolute;
}

}  // namespace virtual_work_dynamics
