#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "bag/byte_cursor.h"

namespace virtual_work_dynamics {

// Records of the bag format 2.0, http://wiki.ros.org/Bags/Format/2.0: a header of named fields and
// data, each behind its length.

constexpr std::string_view kBagVersion = "#ROSBAG V2.0\n";
/// Length of the header and data of the first record, which is written again in the end.
constexpr std::size_t kBagHeaderLength = 4096;

/// Values of the field `op`.
enum class BagOp : std::uint8_t {
  kMessage = 2,
  kBagHeader = 3,
  kIndex = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7
};

/// A topic as one of its publishers has it.
struct BagConnection {
  std::string topic, type, md5sum, definition;
  std::string caller_id;  ///< empty: not known
  bool latching = false;
};

/// The fields of a header.
class BagHeader {
 public:
  explicit BagHeader(std::string_view bytes) : bytes_(bytes) {}

  /// The value of a field; nothing when there is none, or when the header is malformed before it.
  std::optional<std::string_view> find(std::string_view name) const;
  std::optional<std::uint32_t> word(std::string_view name) const;
  std::optional<std::uint64_t> longWord(std::string_view name) const;
  /// ns
  std::optional<std::int64_t> time(std::string_view name) const;
  std::optional<BagOp> op() const;

 private:
  std::string_view bytes_;
};

/// Reads the record of a connection.
/// @returns nothing when a field is missing that every connection has.
std::optional<BagConnection> readConnection(const BagHeader& header, std::string_view data);

}  // namespace virtual_work_dynamics
