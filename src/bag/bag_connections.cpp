#include "bag/bag_connections.h"

#include <unordered_set>

#include "bag/bag_reader.h"

namespace virtual_work_dynamics {

BagConnections connectionsOf(const std::string& path) {
  BagReader reader(path);
  if (reader.indexPosition() > 0 && reader.indexPosition() < reader.size()) {
    const std::uint64_t first = reader.position();
    reader.seek(reader.indexPosition());
    std::vector<BagConnection> connections = reader.readConnections();
    if (!connections.empty()) return {connections, ""};
    reader.seek(first);
  }
  BagConnections found;
  std::unordered_set<const BagConnection*> seen;
  BagMessage message;
  while (reader.next(message)) {
    if (seen.insert(message.connection).second) found.connections.push_back(*message.connection);
  }
  found.damage = reader.damage();
  return found;
}

std::int64_t firstTimeOf(const std::string& path) {
  BagReader reader(path);
  BagMessage message;
  return reader.next(message) ? message.time_ns : 0;
}

}  // namespace virtual_work_dynamics
