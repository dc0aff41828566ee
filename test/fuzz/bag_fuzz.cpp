// A bag from bytes: its topics, its messages, and the table that its joint states make.
#include <fstream>
#include <string>

#include "bag/bag_connections.h"
#include "bag/bag_reader.h"
#include "bag/joint_state_bytes.h"
#include "fuzz_folder.h"
#include "fuzz_target.h"
#include "offline/joint_state_rows.h"

using namespace virtual_work_dynamics;

namespace {

void makeTable(const JointStateRows& rows) {
  if (rows.joints().empty()) return;
  const JointStateRows::Table table = rows.make({rows.joints().front()});
  if (!table.motion.positions.allFinite()) failFuzz("a position that is not finite");
  if (!table.motion.velocities.allFinite()) failFuzz("a velocity that is not finite");
  for (std::size_t i = 1; i < table.stamps_ns.size(); ++i) {
    if (table.stamps_ns[i] <= table.stamps_ns[i - 1]) failFuzz("stamps that do not increase");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const FuzzFolder folder;
  const std::string path = folder.file("in.bag");
  std::ofstream(path, std::ios::binary) << textOf(data, size);
  acceptOrRefuse([&] { connectionsOf(path); });
  acceptOrRefuse([&] {
    const JointRenaming rename;
    JointStateRows rows("message", rename);
    JointStateContent content;
    BagReader reader(path);
    BagMessage message;
    for (std::size_t number = 1; reader.next(message); ++number) {
      if (readJointState(message.bytes, content)) {
        rows.add(content, number);
      } else {
        rows.refuse(number, "not a joint state");
      }
    }
    if (reader.damage().find('\n') != std::string::npos) failFuzz("damage in several lines");
    makeTable(rows);
  });
  return 0;
}
