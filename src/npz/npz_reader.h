#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace virtual_work_dynamics {

/// Whether a file begins like an .npz, which is a zip file.
bool looksLikeNpz(const std::string& path);

/// Reads the one-dimensional arrays of numbers of an .npz, as numpy.savez() writes it.
class NpzReader {
 public:
  /// Reads the directory. @throws FileError naming the path when the file cannot be read, is no zip
  /// file, is compressed, or has arrays of different lengths.
  explicit NpzReader(const std::string& path);

  /// Names of the arrays.
  const std::vector<std::string>& names() const { return names_; }
  /// Names of what is in the file besides, and is no such array.
  const std::vector<std::string>& others() const { return others_; }
  /// Length of the arrays; 0 where there are none.
  std::size_t rows() const { return rows_; }
  /// Whether an array holds times in nanoseconds (datetime64[ns]), which read() gives in seconds.
  bool areTimes(std::size_t array) const { return arrays_[array].kind == Kind::kTime; }

  /// Reads values of an array. @throws FileError when that fails
  void read(std::size_t array, std::size_t first, std::size_t count, std::vector<double>& values);
  /// Reads values of an array of times, in nanoseconds.
  void readTimes(std::size_t array, std::size_t first, std::size_t count,
                 std::vector<std::int64_t>& values);

 private:
  enum class Kind { kDouble, kFloat, kLong, kInt, kTime, kNone };
  struct Array {
    Kind kind = Kind::kNone;
    std::uint64_t place = 0;  // of its values
  };
  struct Entry {
    std::string name;
    std::uint16_t flags = 0, method = 0;
    std::uint64_t packed = 0, length = 0, place = 0;
  };

  [[noreturn]] void fail(const std::string& why) const;
  std::string bytes(std::uint64_t place, std::uint64_t count) const;
  void readDirectory();
  std::string end(std::uint64_t& place) const;
  void takeEntry(Entry entry, std::string_view extra);
  void takeArray(const Entry& entry);
  static Kind kindOf(std::string_view header, std::size_t& rows);
  static std::size_t sizeOf(Kind kind);
  std::string values(std::size_t array, std::size_t first, std::size_t count) const;

  std::string path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::uint64_t size_ = 0;
  std::size_t rows_ = 0;
  std::vector<std::string> names_, others_;
  std::vector<Array> arrays_;
};

}  // namespace virtual_work_dynamics
