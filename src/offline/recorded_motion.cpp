#include "offline/recorded_motion.h"

#include <algorithm>
#include <array>
#include <iostream>
#include <unordered_set>

#include "base/nearest_name.h"
#include "base/printable.h"
#include "dynamics/given_joints.h"
#include "offline/arguments.h"
#include "offline/free_turn_rows.h"
#include "scene/closure_types.h"
#include "scene/resolved_loops.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/unwrap.h"

namespace virtual_work_dynamics {
namespace {

using Names = std::vector<std::string>;
using NameSet = std::unordered_set<std::string>;

// Columns of a pose, in the order of its driven numbers.
constexpr std::array<const char*, Given::kPoseNumbers> kPose{"x", "y", "z", "qx", "qy", "qz", "qw"};
constexpr Eigen::Index kFirstOfQuaternion = 3;

Names poseColumns(const Link& link) {
  Names columns;
  for (const char* number : kPose) columns.push_back("pose." + link.name + "." + number);
  return columns;
}

bool hasDrive(const Scene& scene, const std::string& name) {
  return std::any_of(scene.drives.begin(), scene.drives.end(),
                     [&](const DriveLaw& drive) { return drive.name == name; });
}

void checkRest(const Mechanism& mechanism, const Scene& scene, const RecordingOptions& options) {
  for (const auto& [name, position] : options.rest) {
    if (hasDrive(scene, name)) {
      throw UsageError("--rest: " + inQuotes(name) + " has a drive, which says how it moves");
    }
    if (mechanism.coordinateIndex(name) >= 0) continue;
    throw UsageError("--rest: robot " + inQuotes(mechanism.name()) + " has no joint " +
                     inQuotes(name) + " that moves by itself" +
                     nameHelp(name, mechanism.coordinateNames()));
  }
}

// Chooses what is read from a file by its header, and sets what that gives.
class Choice {
 public:
  Choice(const Mechanism& mechanism, const Scene& scene, const RecordingOptions& options,
         RecordedMotion& motion)
      : mechanism_(mechanism), scene_(scene), options_(options), motion_(motion) {}

  Names choose(const Names& header) {
    columns_ = NameSet(header.begin(), header.end());
    Names wanted;
    if (hasConditions()) wanted = chosen();
    if (wanted.empty() && (scene_.drives.empty() || !hasConditions())) wanted = needed();
    addDrivenClosures();
    return wanted;
  }

 private:
  bool hasConditions() const { return !scene_.closures.empty() || !scene_.couplings.empty(); }

  // The columns of coordinates, closures and poses that the file has.
  Names chosen() {
    Names wanted;
    Given& given = motion_.given;
    const Names& all = mechanism_.coordinateNames();
    given.coordinates.assign(all.size(), false);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const bool has = columns_.count(all[i]) > 0;
      if (has && !isFreeAngle(i)) wanted.push_back(all[i]);
      given.coordinates[i] = has || rests(all[i]) || hasDrive(scene_, all[i]);
    }
    for (std::size_t c = 0; c < scene_.closures.size(); ++c) {
      const Closure& closure = scene_.closures[c];
      if (columns_.count(closure.name) == 0 || !traitsOf(closure.type).free_axis) continue;
      if (mechanism_.jointIndex(closure.name) >= 0) continue;
      wanted.push_back(closure.name);
      if (!hasDrive(scene_, closure.name)) given.closures.push_back(c);
    }
    for (std::size_t link = 1; link < mechanism_.links().size(); ++link) {
      const Names pose = poseColumns(mechanism_.links()[link]);
      const auto has = [this](const std::string& name) { return columns_.count(name) > 0; };
      if (std::none_of(pose.begin(), pose.end(), has)) continue;
      wanted.insert(wanted.end(), pose.begin(), pose.end());
      given.links.push_back(static_cast<int>(link));
    }
    return wanted;
  }

  // The joints of an open chain, or those without which a file gives nothing of closed loops. The
  // file's reader names those that it lacks.
  Names needed() {
    Names wanted;
    const Names& all = mechanism_.coordinateNames();
    motion_.given = Given();
    for (std::size_t i = 0; i < all.size(); ++i) {
      const std::string& name = all[i];
      const bool needs = !hasConditions() || !scene_.actuated ||
                         std::count(scene_.actuated->begin(), scene_.actuated->end(), name) > 0;
      const bool has = columns_.count(name) > 0;
      const bool lacks = !rests(name) && !hasDrive(scene_, name);
      if (!isFreeAngle(i) && (has || (needs && lacks))) wanted.push_back(name);
      motion_.given.coordinates.push_back(needs || has || !lacks);
    }
    return wanted;
  }

  void addDrivenClosures() {
    for (std::size_t c = 0; c < scene_.closures.size(); ++c) {
      if (hasDrive(scene_, scene_.closures[c].name)) motion_.given.closures.push_back(c);
    }
  }

  // Of a joint whose orientation is given instead.
  bool isFreeAngle(std::size_t coordinate) const {
    const int joint = mechanism_.coordinates()[coordinate];
    const CompoundJoint* const compound = mechanism_.compoundOf(joint);
    return compound && compound->turnsFreely() && joint > compound->last - 3;
  }

  bool rests(const std::string& name) const {
    return std::any_of(options_.rest.begin(), options_.rest.end(),
                       [&](const auto& joint) { return joint.first == name; });
  }

  const Mechanism& mechanism_;
  const Scene& scene_;
  const RecordingOptions& options_;
  RecordedMotion& motion_;
  NameSet columns_;
};

// Takes from joint states what the scene says they give, as the node does: drives and they would
// say too much.
void leaveOutPassive(const Mechanism& mechanism, const Scene& scene, MotionSource& source) {
  std::vector<bool> given;
  try {
    given = Dynamics(mechanism, scene, Request()).given().coordinates;
  } catch (const AssemblyError&) {
    given = resolveLoopScene(mechanism, scene).given.coordinates;  // the motion may assemble it
  }
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (!given[i]) source.left_out.push_back(mechanism.coordinateNames()[i]);
  }
}

// Turns angles in degrees into radians, with their derivatives.
void makeRadians(const Mechanism& mechanism, const Scene& scene, RecordedMotion& motion) {
  MotionTable& table = motion.file.table;
  const std::size_t joints = table.joints.size() - motion.drivenColumns();
  const auto turn = [&](std::size_t column) {
    for (Eigen::MatrixXd* values : {&table.positions, &table.velocities, &table.accelerations}) {
      if (values->size() > 0) values->col(static_cast<Eigen::Index>(column)) *= kDegree;
    }
  };
  for (std::size_t i = 0; i < joints; ++i) {
    const int coordinate = mechanism.coordinateIndex(table.joints[i]);
    if (mechanism.unitOf(coordinate) == Unit::kRadian) turn(i);
  }
  for (std::size_t i = 0; i < motion.closureColumns(); ++i) {
    const Closure& closure = scene.closures[motion.given.closures[i]];
    if (traitsOf(closure.type).free_axis == Unit::kRadian) turn(joints + i);
  }
  const auto turnRates = [](auto& rows) {
    for (auto& row : rows) {
      row.angular_velocity *= kDegree;
      row.angular_acceleration *= kDegree;
    }
  };
  turnRates(table.roots);
  for (FreeTurns& turns : table.turns) turnRates(turns.rows);
}

// Adds the whole turns that a driver left out of the angle of a pin.
bool unwrapPin(const std::vector<double>& times, Eigen::Ref<Eigen::VectorXd> angles) {
  constexpr double kTurn = 6.283185307179586476925286766559;
  Joint pin;
  pin.type = JointType::kContinuous;
  TurnCounter counter(pin);
  bool changed = false;
  for (Eigen::Index row = 0; row < angles.size(); ++row) {
    const auto at = static_cast<std::size_t>(row);
    const double turns = counter.turns(angles[row], at == 0 ? 0 : times[at] - times[at - 1]);
    changed = changed || turns != 0;
    angles[row] += kTurn * turns;
  }
  return changed;
}

// A quaternion and its opposite are the same orientation: each row takes the one that is nearer to
// the row before, with its rates.
void straightenQuaternion(Eigen::Index first, MotionTable& table) {
  for (Eigen::Index row = 1; row < table.positions.rows(); ++row) {
    const auto quaternion = table.positions.middleCols<4>(first);
    if (quaternion.row(row).dot(quaternion.row(row - 1)) >= 0) continue;
    for (Eigen::MatrixXd* columns : {&table.positions, &table.velocities, &table.accelerations}) {
      if (columns->size() > 0) columns->middleCols<4>(first).row(row) *= -1;
    }
  }
}

void checkQuaternions(const MotionFile& file, Eigen::Index first, const std::string& link) {
  constexpr double kShortest = 1e-6;
  for (Eigen::Index row = 0; row < file.table.positions.rows(); ++row) {
    if (file.table.positions.middleCols<4>(first).row(row).norm() >= kShortest) continue;
    throw FileError(file.at(static_cast<std::size_t>(row)) + ": the quaternion of " +
                    inQuotes("pose." + link) + " is zero");
  }
}

void straighten(const Mechanism& mechanism, const Scene& scene, RecordedMotion& motion) {
  MotionTable& table = motion.file.table;
  Names wrapped = unwrapPositions(mechanism, table);
  auto column = static_cast<Eigen::Index>(table.joints.size() - motion.drivenColumns());
  for (std::size_t i = 0; i < motion.closureColumns(); ++i) {
    const std::size_t c = motion.given.closures[i];
    const bool turns = traitsOf(scene.closures[c].type).free_axis == Unit::kRadian;
    if (turns && unwrapPin(table.times, table.positions.col(column))) {
      wrapped.push_back(scene.closures[c].name);
    }
    ++column;
  }
  for (const int link : motion.given.links) {
    checkQuaternions(motion.file, column + kFirstOfQuaternion, mechanism.link(link).name);
    straightenQuaternion(column + kFirstOfQuaternion, table);
    column += static_cast<Eigen::Index>(Given::kPoseNumbers);
  }
  if (wrapped.empty()) return;
  std::string names;
  for (const std::string& name : wrapped) names += (names.empty() ? "" : ", ") + name;
  std::cerr << "note: " << printable(motion.file.path)
            << ": whole turns that a driver left out are added to the positions of " << names
            << "\n";
}

}  // namespace

bool RecordedMotion::letMotorsFollow(const Mechanism& mechanism, const Scene& scene) {
  const FollowingMotors found(mechanism, scene, given.coordinates);
  Given all = given;
  for (std::size_t i = 0; i < all.coordinates.size(); ++i) {
    if (found.coordinates()[i]) all.coordinates[i] = true;
  }
  if (!found.any() || !GivenJoints::givesAll(all) || all.drivenNumbers() > 0) return false;
  motors = found;
  given = all;
  return true;
}

MotionStart RecordedMotion::start(const Mechanism& mechanism) const {
  const auto coordinates = static_cast<Eigen::Index>(mechanism.coordinates().size());
  const auto columns = static_cast<Eigen::Index>(drivenColumns());
  const auto closures = static_cast<Eigen::Index>(closureColumns());
  MotionStart start{given, Motion(coordinates),
                    Motion(static_cast<Eigen::Index>(given.drivenNumbers()))};
  const MotionTable& table = file.table;
  const Eigen::Index joints = static_cast<Eigen::Index>(table.joints.size()) - columns;
  for (Eigen::Index i = 0; i < joints; ++i) {
    const std::string& name = table.joints[static_cast<std::size_t>(i)];
    start.motion.q[mechanism.coordinateIndex(name)] = table.positions(0, i);
  }
  for (const auto& [name, position] : resting) {
    start.motion.q[mechanism.coordinateIndex(name)] = position;
  }
  start.motion.orientations.assign(mechanism.orientations(), Eigen::Quaterniond::Identity());
  for (std::size_t i = 0; i < mechanism.orientations(); ++i) {
    for (const FreeTurns& turns : table.turns) {
      if (turns.joint == mechanism.freeJoint(i).name) {
        start.motion.orientations[i] = turns.rows[0].orientation;
      }
    }
  }
  drives.placeFirst(start.motion.q);
  motors.placeIn(start.motion.q);
  if (columns > 0) {
    const Eigen::VectorXd in_file = table.positions.row(0).tail(columns);
    start.driven.q.head(closures) = in_file.head(closures);
    start.driven.q.tail(columns - closures) = in_file.tail(columns - closures);
  }
  const Eigen::VectorXd by_drives = drives.firstOfClosures();
  start.driven.q.segment(closures, by_drives.size()) = by_drives;
  return start;
}

RecordedMotion readRecordedMotion(const MotionSource& source, const Mechanism& mechanism,
                                  const Scene& scene, const RecordingOptions& options) {
  checkRest(mechanism, scene, options);
  RecordedMotion motion;
  Choice choice(mechanism, scene, options, motion);
  MotionSource taken = source;
  for (const auto& joint : options.rest) taken.left_out.push_back(joint.first);
  for (const DriveLaw& drive : scene.drives) taken.left_out.push_back(drive.name);
  if (!scene.drives.empty() && needsClosedLoops(scene)) leaveOutPassive(mechanism, scene, taken);
  motion.file =
      readMotion(taken, mechanism, [&](const Names& header) { return choice.choose(header); });
  const NameSet given(motion.file.table.joints.begin(), motion.file.table.joints.end());
  for (const auto& joint : options.rest) {
    if (given.count(joint.first) == 0) motion.resting.push_back(joint);
  }
  motion.drives = DrivenRows(mechanism, scene, motion.given, source.degrees, options.drive_start_ns,
                             motion.file);
  if (source.degrees) makeRadians(mechanism, scene, motion);
  checkFreeTurns(mechanism, motion.given, motion.file);
  straighten(mechanism, scene, motion);
  return motion;
}

}  // namespace virtual_work_dynamics
