#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "bag/bag_records.h"
#include "base/output_file.h"

namespace virtual_work_dynamics {

/// Writes a bag of format 2.0 without compression. One chunk is in memory, and a line of the index
/// for each chunk and connection.
class BagWriter {
 public:
  /// Begins the bag. @param file an OutputFile that can be rewritten; must outlive it
  explicit BagWriter(OutputFile& file);

  /// Adds a connection. @returns its number.
  std::uint32_t add(const BagConnection& connection);
  /// Writes a message. @param time_ns when it was received, not before 1970
  void write(std::uint32_t connection, std::int64_t time_ns, std::string_view bytes);
  /// Writes the index and commits the file.
  void finish();

 private:
  struct IndexEntry {
    std::int64_t time_ns;
    std::uint32_t offset;  // in the chunk
  };
  struct ChunkCount {
    std::uint32_t connection, messages;
  };
  struct ChunkInfo {
    std::uint64_t position;
    std::int64_t first_ns, last_ns;
    std::vector<ChunkCount> counts;
  };
  struct Connection {
    std::string record;  // as it stands in a chunk and in the index
    bool written = false;
    std::vector<IndexEntry> index;  // of the chunk in memory
  };

  void put(const std::string& bytes);
  void putBagHeader(std::uint64_t index_position);
  void closeChunk();

  OutputFile& file_;
  std::uint64_t position_ = 0;
  std::vector<Connection> connections_;
  std::string chunk_;
  std::int64_t first_ns_ = 0, last_ns_ = 0;  // of the chunk in memory
  std::vector<ChunkInfo> chunks_;
};

}  // namespace virtual_work_dynamics
