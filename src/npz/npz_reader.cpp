#include "npz/npz_reader.h"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "base/number_text.h"
#include "base/printable.h"
#include "npz/npz_format.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr std::uint64_t kLongestComment = 0xffff;
constexpr std::uint64_t kLongestDirectory = 1 << 28;
constexpr std::uint64_t kLongestArrayHeader = 1 << 16;

// A little-endian number in bytes that have it.
std::uint64_t numberAt(std::string_view bytes, std::size_t place, int size) {
  std::uint64_t number = 0;
  for (int i = size - 1; i >= 0; --i) {
    number = number << 8 | static_cast<unsigned char>(bytes[place + static_cast<std::size_t>(i)]);
  }
  return number;
}

template <typename Number>
Number valueAt(const std::string& bytes, std::size_t index) {
  // Of the size of `Number`; its bits, not its value.
  const std::uint64_t bits = numberAt(bytes, index * sizeof(Number), sizeof(Number));
  Number value;
  if constexpr (sizeof(Number) == 8) {
    std::memcpy(&value, &bits, sizeof value);
  } else {
    const auto half = static_cast<std::uint32_t>(bits);
    std::memcpy(&value, &half, sizeof value);
  }
  return value;
}

bool endsWithArray(const std::string& name) {
  const std::string end = npz::kArray;
  return name.size() > end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
}

// What follows a key in the header of an array, which is a dictionary of Python.
std::string_view behindKey(std::string_view header, std::string_view key) {
  const std::size_t place = header.find(key);
  if (place == std::string_view::npos) return {};
  header.remove_prefix(place + key.size());
  header.remove_prefix(std::min(header.size(), header.find_first_not_of(": ")));
  return header;
}

}  // namespace

bool looksLikeNpz(const std::string& path) {
  struct stat status;
  if (stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return false;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             std::fclose);
  char begin[4] = {};
  return file && std::fread(begin, 1, 4, file.get()) == 4 &&
         (std::memcmp(begin, "PK\x03\x04", 4) == 0 || std::memcmp(begin, "PK\x05\x06", 4) == 0);
}

NpzReader::NpzReader(const std::string& path)
    : path_(path), file_(std::fopen(path.c_str(), "rb"), std::fclose) {
  struct stat status;
  if (!file_ || fstat(fileno(file_.get()), &status) != 0) fail(std::strerror(errno));
  size_ = static_cast<std::uint64_t>(status.st_size);
  readDirectory();
}

void NpzReader::fail(const std::string& why) const {
  throw FileError(path_ + ": cannot be read as .npz: " + why);
}

std::string NpzReader::bytes(std::uint64_t place, std::uint64_t count) const {
  if (place > size_ || count > size_ - place) fail("it is cut off or damaged");
  std::string text(static_cast<std::size_t>(count), '\0');
  if (fseeko(file_.get(), static_cast<off_t>(place), SEEK_SET) != 0 ||
      std::fread(&text[0], 1, text.size(), file_.get()) != text.size()) {
    fail(std::strerror(errno));
  }
  return text;
}

// The record at the end of a zip file, and where it begins.
std::string NpzReader::end(std::uint64_t& place) const {
  const std::uint64_t most = std::min(size_, npz::kEndLength + kLongestComment);
  const std::string tail = bytes(size_ - most, most);
  for (std::size_t i = tail.size() - std::min<std::size_t>(tail.size(), npz::kEndLength - 1);
       i-- > 0;) {
    if (numberAt(tail, i, 4) != npz::kEnd) continue;
    place = size_ - most + i;
    return tail.substr(i, npz::kEndLength);
  }
  fail("its end is missing; it is cut off");
}

void NpzReader::readDirectory() {
  std::uint64_t end_place = 0;
  const std::string last = end(end_place);
  std::uint64_t count = numberAt(last, 10, 2);
  std::uint64_t length = numberAt(last, 12, 4), place = numberAt(last, 16, 4);
  if (end_place >= npz::kLocatorLength) {
    const std::string locator = bytes(end_place - npz::kLocatorLength, npz::kLocatorLength);
    if (numberAt(locator, 0, 4) == npz::kEnd64Locator) {
      const std::string end64 = bytes(numberAt(locator, 8, 8), npz::kEnd64Length);
      if (numberAt(end64, 0, 4) != npz::kEnd64) fail("it is damaged");
      count = numberAt(end64, 32, 8);
      length = numberAt(end64, 40, 8);
      place = numberAt(end64, 48, 8);
    }
  }
  if (length > kLongestDirectory) fail("it is damaged");
  const std::string directory = bytes(place, length);
  std::size_t at = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (directory.size() - at < npz::kCentralLength ||
        numberAt(directory, at, 4) != npz::kCentralHeader) {
      fail("it is damaged");
    }
    const std::size_t name = numberAt(directory, at + 28, 2),
                      extra = numberAt(directory, at + 30, 2);
    const std::size_t whole = npz::kCentralLength + name + extra + numberAt(directory, at + 32, 2);
    if (directory.size() - at < whole) fail("it is damaged");
    Entry entry;
    entry.flags = static_cast<std::uint16_t>(numberAt(directory, at + 8, 2));
    entry.method = static_cast<std::uint16_t>(numberAt(directory, at + 10, 2));
    entry.packed = numberAt(directory, at + 20, 4);
    entry.length = numberAt(directory, at + 24, 4);
    entry.place = numberAt(directory, at + 42, 4);
    entry.name = directory.substr(at + npz::kCentralLength, name);
    takeEntry(std::move(entry),
              std::string_view(directory).substr(at + npz::kCentralLength + name, extra));
    at += whole;
  }
}

void NpzReader::takeEntry(Entry entry, std::string_view extra) {
  for (std::size_t at = 0; extra.size() - at >= 4;) {
    const std::size_t length = numberAt(extra, at + 2, 2);
    if (extra.size() - at - 4 < length) break;
    if (numberAt(extra, at, 2) == npz::kExtra64) {
      std::size_t next = at + 4;
      const std::size_t stop = next + length;
      for (std::uint64_t* const number : {&entry.length, &entry.packed, &entry.place}) {
        if (*number != npz::kIn64 || stop - next < 8) continue;
        *number = numberAt(extra, next, 8);
        next += 8;
      }
    }
    at += 4 + length;
  }
  if (!endsWithArray(entry.name)) {
    others_.push_back(entry.name);
    return;
  }
  if (entry.flags & npz::kEncrypted) fail(inQuotes(entry.name) + " is encrypted");
  if (entry.method != npz::kStored || entry.packed != entry.length) {
    fail(inQuotes(entry.name) +
         " is compressed; write it with numpy.savez, not numpy.savez_compressed");
  }
  takeArray(entry);
}

void NpzReader::takeArray(const Entry& entry) {
  const std::string local = bytes(entry.place, npz::kLocalLength);
  if (numberAt(local, 0, 4) != npz::kLocalHeader) fail("it is damaged");
  const std::uint64_t begin =
      entry.place + npz::kLocalLength + numberAt(local, 26, 2) + numberAt(local, 28, 2);
  constexpr std::uint64_t kBefore = 12;  // of the text of the header, at most
  const std::string start = bytes(begin, std::min(entry.length, kBefore));
  const std::string name = entry.name.substr(0, entry.name.size() - std::strlen(npz::kArray));
  if (start.size() < kBefore || start.compare(0, 6, npz::kMagic) != 0) {
    fail(inQuotes(entry.name) + " is no array");
  }
  const bool first_version = start[6] == 1;
  const std::uint64_t before = first_version ? 10 : 12;
  const std::uint64_t length = numberAt(start, 8, first_version ? 2 : 4);
  if (length > kLongestArrayHeader) fail("the header of " + inQuotes(entry.name) + " is damaged");
  Array array;
  std::size_t rows = 0;
  array.kind = kindOf(bytes(begin + before, length), rows);
  array.place = begin + before + length;
  if (array.kind == Kind::kNone) {
    others_.push_back(name);
    return;
  }
  if (before + length > entry.length ||
      (entry.length - before - length) / sizeOf(array.kind) != rows) {
    fail(inQuotes(entry.name) + " has not as many values as it says");
  }
  if (!arrays_.empty() && rows != rows_) {
    fail("the array " + inQuotes(name) + " has " + std::to_string(rows) + " values, " +
         inQuotes(names_[0]) + " has " + std::to_string(rows_));
  }
  rows_ = rows;
  names_.push_back(name);
  arrays_.push_back(array);
}

// What the values of an array are, and how many; kNone: not one-dimensional, or no numbers.
NpzReader::Kind NpzReader::kindOf(std::string_view header, std::size_t& rows) {
  const std::pair<std::string_view, Kind> kKinds[] = {{"'<f8'", Kind::kDouble},
                                                      {"'<f4'", Kind::kFloat},
                                                      {"'<i8'", Kind::kLong},
                                                      {"'<i4'", Kind::kInt},
                                                      {"'<M8[ns]'", Kind::kTime}};
  const std::string_view described = behindKey(header, "'descr'");
  std::string_view shape = behindKey(header, "'shape'");
  const std::size_t comma = shape.find(',');
  if (shape.empty() || shape[0] != '(' || comma == std::string_view::npos || shape.size() < 3 ||
      shape.substr(comma, 2) != ",)") {
    return Kind::kNone;
  }
  double number = 0;
  if (!parseNumber(std::string(shape.substr(1, comma - 1)), number) || number < 0 ||
      number > 1e15) {
    return Kind::kNone;
  }
  rows = static_cast<std::size_t>(number);
  for (const auto& [text, kind] : kKinds) {
    if (described.substr(0, text.size()) == text) return kind;
  }
  return Kind::kNone;
}

std::size_t NpzReader::sizeOf(Kind kind) {
  return kind == Kind::kFloat || kind == Kind::kInt ? 4 : 8;
}

std::string NpzReader::values(std::size_t array, std::size_t first, std::size_t count) const {
  const std::size_t size = sizeOf(arrays_[array].kind);
  return bytes(arrays_[array].place + first * size, count * size);
}

void NpzReader::read(std::size_t array, std::size_t first, std::size_t count,
                     std::vector<double>& values_read) {
  const std::string raw = values(array, first, count);
  values_read.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    switch (arrays_[array].kind) {
      case Kind::kDouble:
        values_read[i] = valueAt<double>(raw, i);
        break;
      case Kind::kFloat:
        values_read[i] = static_cast<double>(valueAt<float>(raw, i));
        break;
      case Kind::kInt:
        values_read[i] = static_cast<double>(valueAt<std::int32_t>(raw, i));
        break;
      case Kind::kLong:
        values_read[i] = static_cast<double>(valueAt<std::int64_t>(raw, i));
        break;
      case Kind::kTime:
      case Kind::kNone:
        values_read[i] = 1e-9 * static_cast<double>(valueAt<std::int64_t>(raw, i));
        break;
    }
  }
}

void NpzReader::readTimes(std::size_t array, std::size_t first, std::size_t count,
                          std::vector<std::int64_t>& ns) {
  const std::string raw = values(array, first, count);
  ns.resize(count);
  for (std::size_t i = 0; i < count; ++i) ns[i] = valueAt<std::int64_t>(raw, i);
}

}  // namespace virtual_work_dynamics
