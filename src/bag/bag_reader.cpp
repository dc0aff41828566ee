#include "bag/bag_reader.h"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "bag/chunk_compression.h"
#include "base/printable.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr std::string_view kAnyVersion = "#ROSBAG V";
constexpr std::string_view kMcap = "\x89MCAP";
constexpr std::string_view kSqlite = "SQLite format 3";
constexpr std::size_t kLongestHeader = std::size_t{1} << 24;  // of a record, bytes

std::string firstBytes(std::FILE* file) {
  std::string bytes(kSqlite.size(), '\0');
  bytes.resize(std::fread(bytes.data(), 1, bytes.size(), file));
  return bytes;
}

bool startsWith(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}

}  // namespace

bool looksLikeBag(const std::string& path) {
  struct stat status;
  if (stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return false;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             std::fclose);
  if (!file) return false;
  const std::string bytes = firstBytes(file.get());
  return startsWith(bytes, kAnyVersion) || startsWith(bytes, kMcap) || startsWith(bytes, kSqlite);
}

BagReader::BagReader(const std::string& path)
    : path_(path), file_(std::fopen(path.c_str(), "rb"), std::fclose) {
  struct stat status;
  if (!file_ || fstat(fileno(file_.get()), &status) != 0) {
    throw FileError(path_ + ": cannot be read: " + std::strerror(errno));
  }
  if (!S_ISREG(status.st_mode)) throw FileError(path_ + ": a bag is read from a file only");
  size_ = static_cast<std::uint64_t>(status.st_size);
  const std::string bytes = firstBytes(file_.get());
  if (startsWith(bytes, kMcap) || startsWith(bytes, kSqlite)) {
    throw FileError(path_ + ": is a recording of ROS 2, and only bags of ROS 1 are read");
  }
  if (!startsWith(bytes, kBagVersion)) {
    const std::string version = bytes.substr(0, bytes.find('\n'));
    throw FileError(path_ + (startsWith(version, kAnyVersion)
                                 ? ": is a bag of " + inQuotes(version.substr(1)) +
                                       ", and only format 2.0 is read; rosbag fix converts it"
                                 : ": is not a bag"));
  }
  seek(kBagVersion.size());
  readBagHeader();
}

void BagReader::seek(std::uint64_t position) {
  if (fseeko(file_.get(), static_cast<off_t>(position), SEEK_SET) != 0) {
    throw FileError(path_ + ": cannot be read: " + std::strerror(errno));
  }
  position_ = position;
  at_end_ = false;
  in_chunk_ = ByteCursor(nullptr, 0);
}

void BagReader::skip(std::uint64_t count) {
  seek(position_ + count);
}

void BagReader::readBytes(char* to, std::size_t count) {
  if (std::fread(to, 1, count, file_.get()) != count) {
    const int error = errno;
    throw FileError(path_ + ": cannot be read: " +
                    (std::ferror(file_.get()) ? std::strerror(error) : "the file became shorter"));
  }
  position_ += count;
}

// Reads bytes that follow their number, or as many as the file has. Returns false when not even the
// number is there.
bool BagReader::readSized(std::vector<char>& bytes) {
  char number[4];
  if (size_ - std::min(size_, position_) < sizeof number) return false;
  readBytes(number, sizeof number);
  const std::uint64_t length = ByteCursor(number, sizeof number).word();
  const std::uint64_t there = std::min(length, size_ - position_);
  cut_ = there < length;
  bytes.resize(static_cast<std::size_t>(there));
  if (!bytes.empty()) readBytes(bytes.data(), bytes.size());
  return true;
}

// Reads the header and the data of the next record, or as much of the data as the file has. Returns
// false where there is none.
bool BagReader::readRecord() {
  record_position_ = position_;
  if (position_ == size_) return false;
  char number[4];
  if (size_ - position_ >= sizeof number) {
    readBytes(number, sizeof number);
    if (ByteCursor(number, sizeof number).word() > kLongestHeader) {
      note(record_position_, "what stands there is not a record");
      return false;
    }
    seek(record_position_);
  }
  if (!readSized(header_) || cut_ || !readSized(data_)) {
    note(record_position_, "the file ends in a record");
    return false;
  }
  return true;
}

void BagReader::readBagHeader() {
  if (!readRecord() || cut_) {
    throw FileError(path_ + ": is cut off before its first message");
  }
  const BagHeader header(std::string_view(header_.data(), header_.size()));
  const auto index = header.longWord("index_pos");
  if (header.op() != BagOp::kBagHeader || !index) {
    throw FileError(path_ + ": is not a bag: its first record is not a header");
  }
  const auto encryptor = header.find("encryptor");
  if (encryptor && !encryptor->empty()) {
    throw FileError(path_ + ": is encrypted by " + inQuotes(*encryptor) +
                    ", which is not read; rosbag decrypt decrypts it");
  }
  index_position_ = *index;
}

std::vector<BagConnection> BagReader::readConnections() {
  std::vector<BagConnection> connections;
  while (readRecord() && !cut_) {
    const BagHeader header(std::string_view(header_.data(), header_.size()));
    if (header.op() != BagOp::kConnection) break;
    auto connection = readConnection(header, std::string_view(data_.data(), data_.size()));
    if (connection) connections.push_back(std::move(*connection));
  }
  return connections;
}

bool BagReader::next(BagMessage& message) {
  while (!at_end_) {
    if (takeFromChunk(message)) return true;
    if (!readRecord()) break;
    const BagHeader header(std::string_view(header_.data(), header_.size()));
    const std::string_view data(data_.data(), data_.size());
    const auto op = header.op();
    if (op == BagOp::kChunk) {
      openChunk(header, record_position_);
      continue;
    }
    if (cut_) {
      note(record_position_, "the file ends in a record");
      break;
    }
    // Messages stand outside of chunks where the latest chunk was not closed.
    const Taken taken = take(header, data, message);
    if (taken == Taken::kMessage) return true;
    if (taken == Taken::kBroken) {
      note(record_position_, "what stands there is not a record");
      break;
    }
  }
  if (!at_end_ && problems_ == 0 && (index_position_ == 0 || index_position_ > size_)) {
    note(size_, "the recording was not closed");
  }
  at_end_ = true;
  return false;
}

void BagReader::openChunk(const BagHeader& header, std::uint64_t begin) {
  const auto compression = header.find("compression");
  const auto size = header.word("size");
  in_chunk_ = ByteCursor(nullptr, 0);
  chunk_position_ = begin;
  if (!compression || !size) {
    note(begin, "a chunk says neither compression nor size");
    return;
  }
  if (data_.empty() && *size == 0) {
    if (*compression != "none") note(begin, "a chunk was not closed");
    return;
  }
  switch (decompressChunk(*compression, {data_.data(), data_.size()}, *size, chunk_)) {
    case Decompressed::kUnknown:
      throw FileError(path_ + ": is compressed by " + inQuotes(*compression) +
                      ", which this build does not read; rosbag decompress makes a bag without");
    case Decompressed::kBroken:
      note(begin, "a chunk cannot be decompressed and is left out");
      return;
    case Decompressed::kCut:
      note(begin, "the file ends in a chunk");
      break;
    case Decompressed::kWhole:
      if (cut_) note(begin, "the file ends in a chunk");
      break;
  }
  in_chunk_ = ByteCursor(chunk_.data(), chunk_.size());
}

// Takes records of the chunk up to a message.
bool BagReader::takeFromChunk(BagMessage& message) {
  while (!in_chunk_.empty()) {
    const BagHeader header(in_chunk_.sized());
    const std::string_view data = in_chunk_.sized();
    if (!in_chunk_.ok()) {
      note(chunk_position_, "a chunk ends in a record");
      return false;
    }
    const Taken taken = take(header, data, message);
    if (taken == Taken::kMessage) return true;
    if (taken == Taken::kBroken) {
      note(chunk_position_, "a chunk holds what is not a record");
      in_chunk_ = ByteCursor(nullptr, 0);
    }
  }
  return false;
}

BagReader::Taken BagReader::take(const BagHeader& header, std::string_view data,
                                 BagMessage& message) {
  const auto op = header.op();
  if (op == BagOp::kIndex || op == BagOp::kChunkInfo || op == BagOp::kBagHeader) {
    return Taken::kOther;
  }
  const auto id = header.word("conn");
  if (!id) return Taken::kBroken;
  if (op == BagOp::kConnection) {
    if (auto connection = readConnection(header, data)) {
      connections_.emplace(*id, std::move(*connection));
      return Taken::kOther;
    }
    return Taken::kBroken;
  }
  const auto time = header.time("time");
  if (op != BagOp::kMessage || !time) return Taken::kBroken;
  const auto connection = connections_.find(*id);
  if (connection == connections_.end()) {
    note(record_position_, "a message belongs to no topic and is left out");
    return Taken::kOther;
  }
  message = {&connection->second, *time, data};
  return Taken::kMessage;
}

void BagReader::note(std::uint64_t position, const std::string& problem) {
  if (++problems_ == 1) problem_ = "byte " + std::to_string(position) + ": " + problem;
}

std::string BagReader::damage() const {
  if (problems_ <= 1) return problem_;
  return problem_ + ", and " + std::to_string(problems_ - 1) +
         (problems_ == 2 ? " more problem" : " more problems");
}

}  // namespace virtual_work_dynamics
