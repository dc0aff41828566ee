#include "motion/free_columns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "motion/orientation_length.h"

namespace virtual_work_dynamics {
namespace {

struct FreeQuantity {
  const char* name;
  const char* components;  // a letter each
  double* (*of)(FreeTurn& turn);
};

constexpr std::array<FreeQuantity, 3> kFreeQuantities{
    {{"orientation", "xyzw", [](FreeTurn& turn) { return turn.orientation.coeffs().data(); }},
     {"angular_velocity", "xyz", [](FreeTurn& turn) { return turn.angular_velocity.data(); }},
     {"angular_acceleration", "xyz",
      [](FreeTurn& turn) { return turn.angular_acceleration.data(); }}}};

// The joint of a column; empty when it is not one of a quantity.
std::string_view jointOf(std::string_view column) {
  for (const FreeQuantity& quantity : kFreeQuantities) {
    const std::string_view name = quantity.name;
    if (column.size() < name.size() + 4 || column.substr(0, name.size()) != name ||
        column[name.size()] != '.' || column[column.size() - 2] != '.') {
      continue;
    }
    if (std::string_view(quantity.components).find(column.back()) == std::string_view::npos) {
      continue;
    }
    return column.substr(name.size() + 1, column.size() - name.size() - 3);
  }
  return {};
}

std::vector<std::string> columnsOf(const FreeQuantity& quantity, const std::string& joint) {
  std::vector<std::string> columns;
  for (const char* component = quantity.components; *component; ++component) {
    columns.push_back(std::string(quantity.name) + "." + joint + "." + *component);
  }
  return columns;
}

// Whether a coordinate is an angle of a joint that turns freely.
bool isFreeAngle(const Mechanism& mechanism, std::size_t coordinate) {
  const int joint = mechanism.coordinates()[coordinate];
  const CompoundJoint* const compound = mechanism.compoundOf(joint);
  return compound && compound->turnsFreely() &&
         mechanism.joint(joint).type != JointType::kPrismatic;
}

}  // namespace

bool isFreeColumn(std::string_view column) {
  return !jointOf(column).empty();
}

std::vector<std::string> freeJointsOf(const std::vector<std::string>& header) {
  std::vector<std::string> joints;
  std::set<std::string_view> seen;
  for (const std::string& column : header) {
    const std::string_view joint = jointOf(column);
    if (!joint.empty() && seen.insert(joint).second) joints.emplace_back(joint);
  }
  return joints;
}

std::vector<std::string> freeColumnsOf(const std::vector<std::string>& header,
                                       const std::string& joint) {
  const std::set<std::string_view> given(header.begin(), header.end());
  std::vector<std::string> wanted;
  for (const FreeQuantity& quantity : kFreeQuantities) {
    const std::vector<std::string> columns = columnsOf(quantity, joint);
    const bool any = std::any_of(columns.begin(), columns.end(), [&](const std::string& column) {
      return given.count(column) > 0;
    });
    if (any) wanted.insert(wanted.end(), columns.begin(), columns.end());
  }
  return wanted;
}

std::string freeColumnsText(const std::string& quantity, const std::string& joint) {
  return quantity + "." + joint + (quantity == "orientation" ? ".{x,y,z,w}" : ".{x,y,z}");
}

std::size_t takeFreeTurns(const std::string& joint, const std::vector<std::string>& columns,
                          const Eigen::MatrixXd& values, MotionTable& table) {
  FreeTurns turns;
  turns.joint = joint;
  turns.rows.resize(static_cast<std::size_t>(values.rows()));
  Eigen::Index column = 0;
  for (const FreeQuantity& quantity : kFreeQuantities) {
    const std::vector<std::string> own = columnsOf(quantity, joint);
    if (std::find(columns.begin(), columns.end(), own.front()) == columns.end()) {
      turns.lack.emplace_back(quantity.name);
      continue;
    }
    for (std::size_t component = 0; component < own.size(); ++component, ++column) {
      for (std::size_t row = 0; row < turns.rows.size(); ++row) {
        quantity.of(turns.rows[row])[component] = values(static_cast<Eigen::Index>(row), column);
      }
    }
  }
  std::size_t first_off = turns.rows.size();
  for (std::size_t row = 0; row < first_off; ++row) {
    Eigen::Quaterniond& orientation = turns.rows[row].orientation;
    const double off = std::abs(orientation.norm() - 1);
    if (!(off <= kOrientationOff)) {
      first_off = row;
      break;
    }
    turns.orientation_error = std::max(turns.orientation_error, off);
    orientation.normalize();
  }
  table.turns.push_back(std::move(turns));
  return first_off;
}

std::vector<std::string> motionColumns(const Mechanism& mechanism) {
  std::vector<std::string> columns;
  for (const char* kind : {"position.", "velocity.", "acceleration."}) {
    for (std::size_t i = 0; i < mechanism.coordinates().size(); ++i) {
      if (!isFreeAngle(mechanism, i)) columns.push_back(kind + mechanism.coordinateNames()[i]);
    }
  }
  for (std::size_t i = 0; i < mechanism.orientations(); ++i) {
    for (const FreeQuantity& quantity : kFreeQuantities) {
      for (std::string& column : columnsOf(quantity, mechanism.freeJoint(i).name)) {
        columns.push_back(std::move(column));
      }
    }
  }
  return columns;
}

void appendMotion(const Mechanism& mechanism, const Motion& motion, std::vector<double>& numbers) {
  for (const Eigen::VectorXd* values : {&motion.q, &motion.qd, &motion.qdd}) {
    for (std::size_t i = 0; i < mechanism.coordinates().size(); ++i) {
      if (!isFreeAngle(mechanism, i)) numbers.push_back((*values)[static_cast<Eigen::Index>(i)]);
    }
  }
  for (std::size_t i = 0; i < mechanism.orientations(); ++i) {
    FreeTurn turn = freeTurnOf(mechanism, i, motion);
    for (const FreeQuantity& quantity : kFreeQuantities) {
      const double* const from = quantity.of(turn);
      numbers.insert(numbers.end(), from,
                     from + std::char_traits<char>::length(quantity.components));
    }
  }
}

}  // namespace virtual_work_dynamics
