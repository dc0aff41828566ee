#pragma once

#include <kdl/chain.hpp>
#include <kdl/jntarray.hpp>
#include <kdl/tree.hpp>

#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

// A mechanism as kdl_parser makes it of its description: a segment for each joint and its child
// link.

KDL::Vector kdlVector(const Vector3l& v);
KDL::JntArray kdlArray(const Eigen::VectorXd& values);

/// The joints of a serial path, see serialPath().
KDL::Chain kdlChain(const Mechanism& mechanism, const std::vector<int>& joints);
KDL::Tree kdlTree(const Mechanism& mechanism);

}  // namespace virtual_work_dynamics
