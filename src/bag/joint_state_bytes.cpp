#include "bag/joint_state_bytes.h"

#include "bag/byte_cursor.h"

namespace virtual_work_dynamics {
namespace {

bool readReals(ByteCursor& cursor, std::vector<double>& values) {
  const std::size_t count = cursor.word();
  if (count > cursor.left() / sizeof(double)) return false;
  values.resize(count);
  for (double& value : values) value = cursor.real();
  return cursor.ok();
}

}  // namespace

bool readJointState(std::string_view bytes, JointStateContent& content) {
  ByteCursor cursor(bytes);
  cursor.word();  // seq
  content.stamp_ns = cursor.time();
  cursor.sized();  // frame_id
  const std::size_t count = cursor.word();
  if (!cursor.ok() || count > cursor.left() / sizeof(std::uint32_t)) return false;
  content.names.resize(count);
  for (std::string& name : content.names) name = cursor.sized();
  return cursor.ok() && readReals(cursor, content.positions) &&
         readReals(cursor, content.velocities) && readReals(cursor, content.efforts) &&
         cursor.empty();
}

}  // namespace virtual_work_dynamics
