#pragma once

#include <string>
#include <vector>

#include "bag/bag_records.h"

namespace virtual_work_dynamics {

/// What a bag has.
struct BagConnections {
  std::vector<BagConnection> connections;
  std::string damage;  ///< as BagReader::damage(), where that may be why there are not more
};

/// Reads the connections of a bag: from its index, or from all of its records where it has none.
/// @throws FileError as BagReader.
BagConnections connectionsOf(const std::string& path);

/// The time at which the first message was received, ns; of a bag without messages, 0.
/// @throws FileError as BagReader.
std::int64_t firstTimeOf(const std::string& path);

}  // namespace virtual_work_dynamics
