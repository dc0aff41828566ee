#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "bag/bag_records.h"

namespace virtual_work_dynamics {

/// Whether a file begins like a recording of ROS, of any version.
bool looksLikeBag(const std::string& path);

/// A message of a bag. It is valid until the next one is read.
struct BagMessage {
  const BagConnection* connection = nullptr;
  std::int64_t time_ns = 0;  ///< when it was received
  std::string_view bytes;    ///< serialized
};

/// Reads the messages of a bag of format 2.0 in the order of the file, one chunk in memory at a
/// time. The index is not needed, so that a recording that was cut off gives what is there. What
/// cannot be read is left out and described by damage().
class BagReader {
 public:
  /// @throws FileError naming the path when it cannot be read or is not such a bag.
  explicit BagReader(const std::string& path);

  /// Reads the next message; false at the end.
  /// @throws FileError for a compression that this build does not read, or when reading fails.
  bool next(BagMessage& message);

  /// What is wrong with the bag as far as it has been read, to stand behind its path; empty when
  /// nothing is.
  std::string damage() const;

  const std::string& path() const { return path_; }
  std::uint64_t size() const { return size_; }          ///< bytes
  std::uint64_t position() const { return position_; }  ///< bytes that have been read
  /// Where the index begins, bytes; 0: the recording was not closed.
  std::uint64_t indexPosition() const { return index_position_; }

  /// Goes to a record.
  void seek(std::uint64_t position);
  /// Reads the connections of the records from here on, up to the first of another kind.
  std::vector<BagConnection> readConnections();

 private:
  enum class Taken { kMessage, kOther, kBroken };

  bool readRecord();
  bool readSized(std::vector<char>& bytes);
  void readBagHeader();
  void openChunk(const BagHeader& header, std::uint64_t begin);
  Taken take(const BagHeader& header, std::string_view data, BagMessage& message);
  bool takeFromChunk(BagMessage& message);
  void note(std::uint64_t position, const std::string& problem);
  void readBytes(char* to, std::size_t count);
  void skip(std::uint64_t count);

  std::string path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::uint64_t size_ = 0, position_ = 0;
  std::uint64_t index_position_ = 0;
  std::uint64_t record_position_ = 0, chunk_position_ = 0;
  bool cut_ = false;  // the latest record ends beyond the file
  bool at_end_ = false;
  std::vector<char> header_, data_, chunk_;
  ByteCursor in_chunk_{nullptr, 0};
  std::unordered_map<std::uint32_t, BagConnection> connections_;
  std::string problem_;       // the first one
  std::size_t problems_ = 0;  // number of them
};

}  // namespace virtual_work_dynamics
