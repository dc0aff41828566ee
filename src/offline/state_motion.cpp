#include "offline/state_motion.h"

#include <unistd.h>

#include <algorithm>
#include <iostream>

#include "base/printable.h"
#include "offline/bag_topic.h"
#include "offline/joint_state_rows.h"
#include "offline/progress.h"
#include "offline/state_csv.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

using Names = std::vector<std::string>;

bool contains(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string messagesText(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " message" : " messages");
}

// Reads all joint states of a topic, with a line on what is wrong with a bag.
void readParts(const MotionSource& source, const std::string& topic, JointStateRows& rows) {
  std::size_t number = 0;
  JointStateContent content;
  for (const std::string& path : bagParts(source)) {
    Progress progress(std::cerr, ProgressLine::whereIs(STDERR_FILENO), "reading " + path);
    BagReader reader(path);
    BagMessage message;
    while (reader.next(message)) {
      progress.update(reader.position(), reader.size());
      if (message.connection->topic != topic) continue;
      ++number;
      if (readJointState(message.bytes, content)) {
        rows.add(content, number);
      } else {
        rows.refuse(number, "its bytes are not those of a joint state");
      }
    }
    warnOfDamage(reader);
  }
}

void describe(const std::string& where, const JointStateRows& rows,
              const JointStateRows::Table& table) {
  const std::string begin = printable(where) + ": ";
  if (rows.refused() > 0) {
    std::cerr << "warning: " << begin << messagesText(rows.refused())
              << " not used, the first because of " << printable(rows.refusal()) << "\n";
  }
  if (table.without_some > 0) {
    std::cerr << "warning: " << begin << messagesText(table.without_some)
              << " not used, which have some of the joints, but not all\n";
  }
  if (table.without_any > 0) {
    std::cerr << "note: " << begin << messagesText(table.without_any)
              << " not used, which have other joints only\n";
  }
  if (table.repeated > 0) {
    std::cerr << "warning: " << begin << messagesText(table.repeated)
              << " not used, whose stamp another one had before\n";
  }
  if (table.velocities_left_out) {
    std::cerr << "warning: " << begin
              << "velocities are not used, as some are missing or not finite\n";
  }
}

// Makes a motion of the collected joint states.
MotionFile motionOf(const JointStateRows& rows, const MotionSource& source,
                    const std::string& where, const JointChoice& choose, Names& unused) {
  if (rows.joints().empty()) {
    throw FileError(where + ": no message can be used" +
                    (rows.refused() == 0 ? "" : ", the first because of " + rows.refusal()));
  }
  Names offered;
  for (const std::string& name : rows.joints()) {
    if (!contains(source.left_out, name)) offered.push_back(name);
  }
  const Names joints = choose(offered);
  for (const std::string& name : offered) {
    if (!contains(joints, name)) unused.push_back(name);
  }
  MotionFile motion;
  motion.path = source.name();
  motion.row_name = rows.rowName();
  JointStateRows::Table table;
  try {
    table = rows.make(joints);
  } catch (const Error& error) {
    throw FileError(where + ": " + error.what());
  }
  describe(where, rows, table);
  motion.table = std::move(table.motion);
  motion.lines = std::move(table.messages);
  motion.stamps_ns = std::move(table.stamps_ns);
  return motion;
}

}  // namespace

void warnOfDamage(const BagReader& reader) {
  if (reader.damage().empty()) return;
  std::cerr << "warning: " << printable(reader.path())
            << ": is damaged, what can be read is: " << printable(reader.damage()) << "\n";
}

MotionFile readBagMotion(const MotionSource& source, const JointChoice& choose, Names& unused) {
  const std::string topic = jointStateTopic(source);
  JointStateRows rows("message", source.rename);
  readParts(source, topic, rows);
  return motionOf(rows, source, source.name() + ": " + topic, choose, unused);
}

MotionFile readStateCsv(TextSource& text, const MotionSource& source, const JointChoice& choose,
                        Names& unused) {
  const std::string name = source.name();
  JointStateRows rows("line", source.rename);
  StateCsv csv(text, name);
  JointStateContent content;
  while (csv.next(content)) rows.add(content, csv.line());
  return motionOf(rows, source, name, choose, unused);
}

}  // namespace virtual_work_dynamics
