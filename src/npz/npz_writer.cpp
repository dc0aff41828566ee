#include "npz/npz_writer.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <utility>

#include "npz/crc32.h"
#include "npz/npy_header.h"
#include "npz/npz_format.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr std::size_t kValue = 8;            // bytes
constexpr std::size_t kHeldBytes = 8 << 20;  // values in memory, of all columns
constexpr std::size_t kFewestHeld = 64;      // of each column
constexpr std::size_t kMostHeld = 1 << 16;

// Little-endian, whatever the machine.
void append(std::string& bytes, std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i) bytes += static_cast<char>(value >> 8 * i & 0xff);
}

}  // namespace

NpzWriter::NpzWriter(OutputFile& file, const std::vector<NpzColumn>& columns, std::size_t rows,
                     const std::vector<NpzText>& texts, std::uint64_t most32)
    : file_(file),
      most32_(most32),
      rows_(rows),
      held_most_(std::clamp(kHeldBytes / kValue / std::max<std::size_t>(1, columns.size()),
                            kFewestHeld, kMostHeld)),
      held_(columns.size()) {
  if (!file.canRewrite()) {
    throw FileError("an .npz is written to a file, not to standard output, a pipe or a device");
  }
  for (const NpzColumn& column : columns) {
    const std::string header = npyHeader(column.times ? "<M8[ns]" : "<f8", {rows});
    Entry entry;
    entry.name = column.name + npz::kArray;
    entry.length = header.size() + kValue * rows;
    begin(std::move(entry), header);
    next_.push_back(place_ - kValue * rows);
  }
  for (const NpzText& text : texts) {
    Entry entry;
    entry.name = text.name;
    entry.length = text.text.size();
    begin(std::move(entry), text.text);
  }
}

// Writes the first bytes of an entry to its place.
void NpzWriter::begin(Entry entry, const std::string& begin) {
  entry.place = place_;
  entry.crc = continuedCrc32(0, begin);
  const std::string header = localHeader(entry);
  file_.rewrite(place_, header + begin);
  place_ += header.size() + entry.length;
  entries_.push_back(std::move(entry));
}

void NpzWriter::add(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  addBits(bits);
}

void NpzWriter::addTime(std::int64_t ns) {
  addBits(static_cast<std::uint64_t>(ns));
}

void NpzWriter::addBits(std::uint64_t bits) {
  append(held_[column_], bits, static_cast<int>(kValue));
  if (++column_ < held_.size()) return;
  column_ = 0;
  ++written_;
  if (held_[0].size() == kValue * held_most_) writeRows();
}

void NpzWriter::writeRows() {
  for (std::size_t i = 0; i < held_.size(); ++i) {
    if (held_[i].empty()) continue;
    file_.rewrite(next_[i], held_[i]);
    next_[i] += held_[i].size();
    entries_[i].crc = continuedCrc32(entries_[i].crc, held_[i]);
    held_[i].clear();
  }
}

std::string NpzWriter::localHeader(const Entry& entry) const {
  const bool in64 = isLong(entry.length);
  std::string header;
  append(header, npz::kLocalHeader, 4);
  append(header, in64 ? npz::kVersion64 : npz::kVersion, 2);
  append(header, npz::kUtf8Names, 2);
  append(header, npz::kStored, 2);
  append(header, 0, 2);  // time
  append(header, npz::kFirstDay, 2);
  append(header, entry.crc, 4);
  for (int i = 0; i < 2; ++i) append(header, in64 ? npz::kIn64 : entry.length, 4);
  append(header, entry.name.size(), 2);
  append(header, in64 ? 20 : 0, 2);
  header += entry.name;
  if (!in64) return header;
  append(header, npz::kExtra64, 2);
  append(header, 16, 2);
  for (int i = 0; i < 2; ++i) append(header, entry.length, 8);
  return header;
}

std::string NpzWriter::centralHeader(const Entry& entry) const {
  const bool length64 = isLong(entry.length), place64 = isLong(entry.place);
  std::string extra;
  for (int i = 0; i < 2 && length64; ++i) append(extra, entry.length, 8);
  if (place64) append(extra, entry.place, 8);
  const bool in64 = !extra.empty();
  std::string header;
  append(header, npz::kCentralHeader, 4);
  for (int i = 0; i < 2; ++i) append(header, in64 ? npz::kVersion64 : npz::kVersion, 2);
  append(header, npz::kUtf8Names, 2);
  append(header, npz::kStored, 2);
  append(header, 0, 2);
  append(header, npz::kFirstDay, 2);
  append(header, entry.crc, 4);
  for (int i = 0; i < 2; ++i) append(header, length64 ? npz::kIn64 : entry.length, 4);
  append(header, entry.name.size(), 2);
  append(header, in64 ? extra.size() + 4 : 0, 2);
  append(header, 0, 2);  // comment
  append(header, 0, 8);  // disk, attributes
  append(header, place64 ? npz::kIn64 : entry.place, 4);
  header += entry.name;
  if (!in64) return header;
  append(header, npz::kExtra64, 2);
  append(header, extra.size(), 2);
  return header + extra;
}

std::string NpzWriter::end(std::uint64_t directory, std::uint64_t length) const {
  const std::uint64_t count = entries_.size();
  const bool in64 = isLong(directory) || isLong(length) || count >= npz::kCountIn64;
  std::string bytes;
  if (in64) {
    append(bytes, npz::kEnd64, 4);
    append(bytes, npz::kEnd64Length - 12, 8);
    for (int i = 0; i < 2; ++i) append(bytes, npz::kVersion64, 2);
    append(bytes, 0, 8);  // disks
    for (int i = 0; i < 2; ++i) append(bytes, count, 8);
    append(bytes, length, 8);
    append(bytes, directory, 8);
    append(bytes, npz::kEnd64Locator, 4);
    append(bytes, 0, 4);
    append(bytes, directory + length, 8);
    append(bytes, 1, 4);
  }
  append(bytes, npz::kEnd, 4);
  append(bytes, 0, 4);
  for (int i = 0; i < 2; ++i) append(bytes, in64 ? npz::kCountIn64 : count, 2);
  append(bytes, in64 ? npz::kIn64 : length, 4);
  append(bytes, in64 ? npz::kIn64 : directory, 4);
  append(bytes, 0, 2);
  return bytes;
}

void NpzWriter::finish() {
  assert(written_ == rows_ && column_ == 0);
  writeRows();
  std::string directory;
  for (const Entry& entry : entries_) {
    file_.rewrite(entry.place, localHeader(entry));  // now with its CRC
    directory += centralHeader(entry);
  }
  directory += end(place_, directory.size());
  file_.rewrite(place_, directory);
  file_.commit();
}

}  // namespace virtual_work_dynamics
