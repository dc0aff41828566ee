#include "bag/bag_writer.h"

#include <algorithm>

#include "bag/byte_writer.h"

namespace virtual_work_dynamics {
namespace {

// Content at which a chunk is closed, as rosbag does it, bytes.
constexpr std::size_t kChunk = 768 * 1024;
constexpr std::uint32_t kIndexVersion = 1;

// Makes the header of a record.
class Fields {
 public:
  explicit Fields(BagOp op) { text("op", std::string(1, static_cast<char>(op))); }

  Fields& text(std::string_view name, std::string_view value) {
    appendWord(bytes_, static_cast<std::uint32_t>(name.size() + 1 + value.size()));
    (bytes_ += name) += '=';
    bytes_ += value;
    return *this;
  }
  Fields& word(std::string_view name, std::uint32_t value) {
    std::string bytes;
    appendWord(bytes, value);
    return text(name, bytes);
  }
  Fields& longWord(std::string_view name, std::uint64_t value) {
    std::string bytes;
    appendLongWord(bytes, value);
    return text(name, bytes);
  }
  Fields& time(std::string_view name, std::int64_t ns) {
    std::string bytes;
    appendTime(bytes, ns);
    return text(name, bytes);
  }
  const std::string& bytes() const { return bytes_; }

  // The record with this header.
  std::string with(std::string_view data) const {
    std::string record;
    appendSized(record, bytes_);
    appendSized(record, data);
    return record;
  }

 private:
  std::string bytes_;
};

std::string connectionRecord(std::uint32_t number, const BagConnection& connection) {
  std::string described;
  const auto add = [&](std::string_view name, std::string_view value) {
    appendWord(described, static_cast<std::uint32_t>(name.size() + 1 + value.size()));
    (described += name) += '=';
    described += value;
  };
  add("topic", connection.topic);
  add("type", connection.type);
  add("md5sum", connection.md5sum);
  add("message_definition", connection.definition);
  if (!connection.caller_id.empty()) add("callerid", connection.caller_id);
  if (connection.latching) add("latching", "1");
  return Fields(BagOp::kConnection)
      .word("conn", number)
      .text("topic", connection.topic)
      .with(described);
}

// The fields of a message, whose values are put in their places. They are written for each one.
void appendMessage(std::string& bytes, std::uint32_t connection, std::int64_t time_ns,
                   std::string_view data) {
  constexpr std::string_view kOp("\4\0\0\0op=\2", 8);
  constexpr std::string_view kConnection("\x09\0\0\0conn=", 9);
  constexpr std::string_view kTime("\x0d\0\0\0time=", 9);
  constexpr std::size_t kLength = kOp.size() + kConnection.size() + 4 + kTime.size() + 8;
  appendWord(bytes, static_cast<std::uint32_t>(kLength));
  (bytes += kOp) += kConnection;
  appendWord(bytes, connection);
  bytes += kTime;
  appendTime(bytes, time_ns);
  appendSized(bytes, data);
}

}  // namespace

BagWriter::BagWriter(OutputFile& file) : file_(file) {
  put(std::string(kBagVersion));
  putBagHeader(0);
}

void BagWriter::put(const std::string& bytes) {
  file_.write(bytes);
  position_ += bytes.size();
}

void BagWriter::putBagHeader(std::uint64_t index_position) {
  const Fields header = Fields(BagOp::kBagHeader)
                            .longWord("index_pos", index_position)
                            .word("conn_count", static_cast<std::uint32_t>(connections_.size()))
                            .word("chunk_count", static_cast<std::uint32_t>(chunks_.size()));
  const std::string padding(kBagHeaderLength - header.bytes().size(), ' ');
  if (index_position == 0) {
    put(header.with(padding));
  } else {
    file_.rewrite(kBagVersion.size(), header.with(padding));
  }
}

std::uint32_t BagWriter::add(const BagConnection& connection) {
  const auto number = static_cast<std::uint32_t>(connections_.size());
  connections_.emplace_back();
  connections_.back().record = connectionRecord(number, connection);
  return number;
}

void BagWriter::write(std::uint32_t connection, std::int64_t time_ns, std::string_view bytes) {
  Connection& written = connections_[connection];
  if (chunk_.empty()) first_ns_ = last_ns_ = time_ns;
  if (!written.written) chunk_ += written.record;
  written.written = true;
  written.index.push_back({time_ns, static_cast<std::uint32_t>(chunk_.size())});
  appendMessage(chunk_, connection, time_ns, bytes);
  first_ns_ = std::min(first_ns_, time_ns);
  last_ns_ = std::max(last_ns_, time_ns);
  if (chunk_.size() >= kChunk) closeChunk();
}

void BagWriter::closeChunk() {
  if (chunk_.empty()) return;
  chunks_.push_back({position_, first_ns_, last_ns_, {}});
  const Fields header = Fields(BagOp::kChunk)
                            .text("compression", "none")
                            .word("size", static_cast<std::uint32_t>(chunk_.size()));
  std::string begin;
  appendSized(begin, header.bytes());
  appendWord(begin, static_cast<std::uint32_t>(chunk_.size()));
  put(begin);
  put(chunk_);
  chunk_.clear();
  for (std::size_t i = 0; i < connections_.size(); ++i) {
    std::vector<IndexEntry>& index = connections_[i].index;
    if (index.empty()) continue;
    const auto number = static_cast<std::uint32_t>(i);
    const auto count = static_cast<std::uint32_t>(index.size());
    chunks_.back().counts.push_back({number, count});
    std::string entries;
    for (const IndexEntry& entry : index) {
      appendTime(entries, entry.time_ns);
      appendWord(entries, entry.offset);
    }
    put(Fields(BagOp::kIndex)
            .word("ver", kIndexVersion)
            .word("conn", number)
            .word("count", count)
            .with(entries));
    index.clear();
  }
}

void BagWriter::finish() {
  closeChunk();
  const std::uint64_t index_position = position_;
  for (const Connection& connection : connections_) put(connection.record);
  for (const ChunkInfo& chunk : chunks_) {
    std::string counts;
    for (const ChunkCount& count : chunk.counts) {
      appendWord(counts, count.connection);
      appendWord(counts, count.messages);
    }
    put(Fields(BagOp::kChunkInfo)
            .word("ver", kIndexVersion)
            .longWord("chunk_pos", chunk.position)
            .time("start_time", chunk.first_ns)
            .time("end_time", chunk.last_ns)
            .word("count", static_cast<std::uint32_t>(chunk.counts.size()))
            .with(counts));
  }
  putBagHeader(index_position);
  file_.commit();
}

}  // namespace virtual_work_dynamics
