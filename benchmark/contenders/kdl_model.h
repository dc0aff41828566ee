#pragma once

#include <kdl/chain.hpp>
#include <kdl/jntarray.hpp>
#include <kdl/tree.hpp>

#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

// KDL models of a mechanism as kdl_parser makes them of its description: each joint with its child
// link is a segment.

KDL::Vector kdlVector(const Vector3l& v);
KDL::JntArray kdlArray(const Eigen::VectorXd& values);

/// The chain of the joints of a serial path, see serialPath().
KDL::Chain kdlChain(const Mechanism& mechanism, const std::vector<int>& joints);
KDL::Tree kdlTree(const Mechanism& mechanism);

}  // namespace virtual_work_dynamics
