#include "virtual_work_dynamics/motion_csv.h"

#include <algorithm>
#include <array>
#include <functional>
#include <istream>
#include <map>
#include <string_view>
#include <utility>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "base/printable.h"
#include "base/text_file.h"
#include "base/wrench_components.h"
#include "motion/csv_lines.h"
#include "motion/free_columns.h"
#include "motion/motion_text.h"
#include "motion/root_columns.h"
#include "motion/wrench_columns.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr char kTime[] = "time";
constexpr char kStamp[] = "stamp";  // of results of a bag
constexpr std::array<const char*, 3> kKinds{"position", "velocity", "acceleration"};
// Columns that recordings and results have besides, and that no motion is read from.
constexpr std::array<const char*, 7> kIgnored{"effort",    "reaction", "determined", "deviation",
                                              "tolerance", "residual", "certificate"};
constexpr char kKnownColumns[] = "time, position.<joint>, velocity.<joint>, acceleration.<joint>";

template <std::size_t size>
bool isOneOf(const std::array<const char*, size>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

// Whether a column is named after one of these kinds and a joint: "position.hinge".
template <std::size_t size>
bool isOf(const std::array<const char*, size>& kinds, std::string_view column) {
  const std::size_t point = column.find('.');
  return point != std::string_view::npos && point + 1 < column.size() &&
         isOneOf(kinds, column.substr(0, point));
}

// What could be meant by a column of an unknown kind.
std::string columnHelp(std::string_view column) {
  if (column.find(';') != std::string_view::npos) {
    return "; cells are separated by commas, not semicolons, and numbers have a decimal point";
  }
  if (column.find('\t') != std::string_view::npos) return "; cells are separated by commas";
  if (column.substr(0, 7) == "wrench.") return std::string(", ") + kWrenchColumns;
  for (const char* kind : {"orientation.", "angular_velocity.", "angular_acceleration."}) {
    if (column.rfind(kind, 0) == 0) return std::string(", ") + kFreeColumns;
  }
  if (column.substr(0, 5) == "root.") return std::string(", ") + kRootColumns;
  const std::size_t point = std::min(column.find('.'), column.size());
  const std::vector<std::string> kinds(kKinds.begin(), kKinds.end());
  const std::string time = nearestName(std::string(column), {kTime});
  const std::string kind = nearestName(std::string(column.substr(0, point)), kinds);
  if (!time.empty()) return "; did you mean 'time'?";
  if (kind.empty() || point + 1 >= column.size()) return "";
  return "; did you mean " + inQuotes(kind + std::string(column.substr(point))) + "?";
}

// A stream as text.
class StreamSource : public TextSource {
 public:
  StreamSource(std::istream& stream, const std::string& name) : stream_(stream), name_(name) {}
  std::size_t read(char* to, std::size_t most) override {
    stream_.read(to, static_cast<std::streamsize>(most));
    if (stream_.bad()) throw FileError(name_ + ": cannot be read");
    return static_cast<std::size_t>(stream_.gcount());
  }

 private:
  std::istream& stream_;
  const std::string& name_;
};

// Reads one CSV text into a table: first the header, which says where each column goes, then the
// rows.
class CsvReader {
 public:
  CsvReader(TextSource& text, const std::string& name,
            std::function<std::string(const std::string&)> rename = {})
      : lines_(text, name), name_(name), rename_(std::move(rename)) {}

  MotionTable read(const std::vector<std::string>& joints, std::vector<std::string>* unused,
                   std::vector<std::size_t>* line_numbers) {
    return read(
        [&](const std::vector<std::string>& with_positions) {
          if (joints.empty() && with_positions.empty() && header_.size() > 1) {
            throw FileError(atHeader() + ": no column position.<joint>");
          }
          return joints.empty() ? with_positions : joints;
        },
        unused, line_numbers);
  }

  MotionTable read(const JointChoice& choose, std::vector<std::string>* unused,
                   std::vector<std::size_t>* line_numbers) {
    readHeader();
    table_.joints = choose(jointsWithMotion());
    assignColumns();
    if (unused != nullptr) {
      unused->clear();
      for (std::size_t column = 0; column < header_.size(); ++column) {
        if (target_of_column_[column] < 0 && !header_[column].empty()) {
          unused->push_back(header_[column]);
        }
      }
    }
    std::vector<std::size_t> numbers;
    const std::vector<double> values = readRows(numbers);
    fillTable(values, numbers);
    if (line_numbers != nullptr) *line_numbers = std::move(numbers);
    return std::move(table_);
  }

 private:
  std::string atLine(std::size_t line) const { return name_ + ": line " + std::to_string(line); }
  std::string atHeader() const { return atLine(header_line_); }
  std::string atCell(std::size_t line, std::size_t column) const {
    return atLine(line) + ", column " + std::to_string(column + 1);
  }

  void readHeader() {
    if (!lines_.next(true)) {
      throw FileError(name_ + (lines_.number() == 0 ? ": the file is empty"
                                                    : ": no header, only comments or blank lines"));
    }
    header_line_ = lines_.number();
    ends_with_comma_ = lines_.text().size() > 1 && lines_.text().back() == ',';
    const std::string_view line =
        lines_.text().substr(0, lines_.text().size() - (ends_with_comma_ ? 1 : 0));
    forEachCell(line, [this](std::size_t column, std::string_view cell) {
      std::string column_name(cell);
      const bool known = isKnown(column, column_name);
      if (known && rename_) renameJoint(column_name);
      const auto inserted = column_of_name_.emplace(column_name, column);
      if (known && !inserted.second) {
        throw FileError(atCell(header_line_, column) + ": " + inQuotes(column_name) +
                        " already stands in column " + std::to_string(inserted.first->second + 1));
      }
      header_.push_back(std::move(column_name));
    });
  }

  void renameJoint(std::string& column_name) const {
    const bool free = isFreeColumn(column_name);
    if (!free && !isOf(kKinds, column_name)) return;
    const std::size_t begin = column_name.find('.') + 1;
    const std::size_t length = free ? column_name.rfind('.') - begin : column_name.size() - begin;
    column_name.replace(begin, length, rename_(column_name.substr(begin, length)));
  }

  // Whether a column may be of use. Others are ignored, unless something else seems to be meant.
  bool isKnown(std::size_t column, const std::string& column_name) const {
    if (column_name == kTime || column_name == kStamp || isOf(kKinds, column_name) ||
        isOf(kIgnored, column_name) || !wrenchOf(column_name).empty() ||
        isRootColumn(column_name) || isFreeColumn(column_name)) {
      return true;
    }
    const std::string help = columnHelp(column_name);
    if (help.empty()) return false;
    throw FileError(atCell(header_line_, column) + ": " + inQuotes(column_name) +
                    " is not one of " + kKnownColumns + help);
  }

  std::vector<std::string> jointsWithPositions() const {
    const std::string prefix = std::string(kKinds[0]) + ".";
    std::vector<std::string> joints;
    for (const std::string& column_name : header_) {
      if (column_name.compare(0, prefix.size(), prefix) == 0) {
        joints.push_back(column_name.substr(prefix.size()));
      }
    }
    return joints;
  }

  // Also the angles of joints that turn freely, whose orientations are their positions.
  std::vector<std::string> jointsWithMotion() const {
    std::vector<std::string> joints = jointsWithPositions();
    for (const std::string& joint : freeJointsOf(header_)) {
      for (const char* angle : {".rx", ".ry", ".rz"}) joints.push_back(joint + angle);
    }
    return joints;
  }

  // Decides for each column where its value goes in a row of targets, or -1 for nowhere. The
  // targets are the time, then each kind that is given, joint by joint, then the wrenches and the
  // root.
  void assignColumns() {
    target_of_column_.assign(header_.size(), -1);
    assign(kTime, 0);
    int target = 1;
    for (std::size_t kind = 0; kind < kKinds.size(); ++kind) {
      const auto columnName = [&](const std::string& joint) {
        return std::string(kKinds[kind]) + "." + joint;
      };
      const bool wanted = std::any_of(
          table_.joints.begin(), table_.joints.end(),
          [&](const std::string& joint) { return column_of_name_.count(columnName(joint)) > 0; });
      has_kind_[kind] = kind == 0 || wanted;
      if (!has_kind_[kind]) continue;
      const char* why = kind == 0 ? "" : ", though other joints have one: give all or none";
      for (const std::string& joint : table_.joints) assign(columnName(joint), target++, why);
    }
    table_.wrenches = wrenchesOf(header_);
    for (const std::string& wrench : table_.wrenches) {
      for (const char* component : kWrenchComponents) {
        assign(wrenchColumn(wrench, component), target++, ": a wrench has all six");
      }
    }
    root_columns_ = rootColumnsOf(header_);
    for (const std::string& column : root_columns_) {
      assign(column, target++, ", though other components of it are there");
    }
    free_joints_ = freeJointsOf(header_);
    for (const std::string& joint : free_joints_) {
      free_columns_.push_back(freeColumnsOf(header_, joint));
      for (const std::string& column : free_columns_.back()) {
        assign(column, target++, ", though other components of it are there");
      }
    }
    targets_ = static_cast<std::size_t>(target);
  }

  void assign(const std::string& column_name, int target, const char* why = "") {
    const auto found = column_of_name_.find(column_name);
    if (found == column_of_name_.end()) {
      throw FileError(atHeader() + ": column " + inQuotes(column_name) + " is missing" +
                      (*why ? why : missingHelp(column_name)));
    }
    target_of_column_[found->second] = target;
  }

  // What may stand in the place of a missing column: one of the same kind that is not wanted.
  std::string missingHelp(const std::string& column_name) const {
    const std::string kind = column_name.substr(0, column_name.find('.') + 1);
    std::vector<std::string> columns, names;
    for (const std::string& other : header_) {
      if (other.empty() || other == kTime || other.compare(0, kind.size(), kind) != 0) continue;
      const std::string name = other.substr(kind.size());
      const auto& wanted = table_.joints;
      if (std::find(wanted.begin(), wanted.end(), name) != wanted.end()) continue;
      columns.push_back(other);
      names.push_back(name);
    }
    const std::string bare = column_name.substr(kind.size());
    if (!kind.empty() && column_of_name_.count(bare) > 0) return ", and there is " + inQuotes(bare);
    const std::string nearest = nearestName(bare, names);
    if (!nearest.empty()) return "; is it " + inQuotes(kind + nearest) + "?";
    return columns.empty() || kind.empty() ? "" : "; there are " + namesInQuotes(columns);
  }

  // Calls `use(column index, cell)` for every cell of a line.
  template <typename Use>
  void forEachCell(std::string_view line, Use use) {
    if (line.find('"') == std::string_view::npos) return forEachPlainCell(line, use);
    if (!splitQuoted(line, cells_)) {
      throw FileError(atLine(lines_.number()) + ": its quotes do not match");
    }
    for (std::size_t column = 0; column < cells_.size(); ++column) use(column, cells_[column]);
  }

  // Counts the cells of a row first: behind a missing cell, its numbers are in wrong columns.
  void checkCount(std::string_view line) {
    std::size_t cells = static_cast<std::size_t>(std::count(line.begin(), line.end(), ',')) + 1;
    if (line.find('"') != std::string_view::npos) {
      cells = 0;
      forEachCell(line, [&](std::size_t, std::string_view) { ++cells; });
    }
    if (cells == header_.size()) return;
    throw FileError(atLine(lines_.number()) + ": " + std::to_string(header_.size()) +
                    " cells expected as in the header, " + std::to_string(cells) + " found" +
                    (line.find(';') != std::string_view::npos
                         ? "; cells are separated by commas, not semicolons"
                         : ""));
  }

  std::vector<double> readRows(std::vector<std::size_t>& line_numbers) {
    std::vector<double> values;
    std::string number;
    while (lines_.next(false)) {
      const std::size_t row_start = values.size();
      values.resize(row_start + targets_);
      const auto readCell = [&](std::size_t column, std::string_view cell) {
        if (column >= header_.size() || target_of_column_[column] < 0) return;
        number.assign(cell.data(), cell.size());
        double& value = values[row_start + static_cast<std::size_t>(target_of_column_[column])];
        if (!parseNumber(number, value)) throwNoNumber(column, cell);
      };
      std::string_view line = lines_.text();
      if (ends_with_comma_ && line.back() == ',') line.remove_suffix(1);
      checkCount(line);
      forEachCell(line, readCell);
      line_numbers.push_back(lines_.number());
    }
    if (values.empty()) throw FileError(name_ + ": no rows after the header");
    return values;
  }

  [[noreturn]] void throwNoNumber(std::size_t column, std::string_view cell) const {
    throw FileError(
        atCell(lines_.number(), column) + " (" + header_[column] +
        "): " + (cell.empty() ? "the cell is empty" : inQuotes(cell) + " is not a finite number"));
  }

  void fillTable(const std::vector<double>& values, const std::vector<std::size_t>& numbers) {
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const Eigen::Map<const RowMajor> rows(values.data(),
                                          static_cast<Eigen::Index>(values.size() / targets_),
                                          static_cast<Eigen::Index>(targets_));
    const auto joints = static_cast<Eigen::Index>(table_.joints.size());
    table_.times.resize(static_cast<std::size_t>(rows.rows()));
    for (Eigen::Index row = 0; row < rows.rows(); ++row) {
      table_.times[static_cast<std::size_t>(row)] = rows(row, 0);
    }
    Eigen::Index start = 1;
    Eigen::MatrixXd* const matrices[] = {&table_.positions, &table_.velocities,
                                         &table_.accelerations};
    for (std::size_t kind = 0; kind < kKinds.size(); ++kind) {
      if (!has_kind_[kind]) continue;
      *matrices[kind] = rows.middleCols(start, joints);
      start += joints;
    }
    const auto wrenches = static_cast<Eigen::Index>(6 * table_.wrenches.size());
    table_.wrench_values = rows.middleCols(start, wrenches);
    start += wrenches;
    const auto requireUnit = [&](std::size_t row, const std::string& columns, const auto& turned) {
      if (row >= numbers.size()) return;
      throw FileError(atLine(numbers[row]) + ": " + columns + " has the length " +
                      numberText(turned[row].orientation.norm()) + ", not 1");
    };
    const auto of_root = static_cast<Eigen::Index>(root_columns_.size());
    requireUnit(takeRoots(root_columns_, rows.middleCols(start, of_root), table_),
                rootColumnsText("orientation"), table_.roots);
    start += of_root;
    for (std::size_t i = 0; i < free_joints_.size(); ++i) {
      const auto count = static_cast<Eigen::Index>(free_columns_[i].size());
      const std::size_t row =
          takeFreeTurns(free_joints_[i], free_columns_[i], rows.middleCols(start, count), table_);
      requireUnit(row, freeColumnsText("orientation", free_joints_[i]), table_.turns.back().rows);
      start += count;
    }
  }

  CsvLines lines_;
  const std::string& name_;
  const std::function<std::string(const std::string&)> rename_;  // of joints; empty: they stay
  std::size_t header_line_ = 0;
  bool ends_with_comma_ = false;    // the header, and so its rows may
  std::vector<std::string> cells_;  // of a line with quotes
  std::vector<std::string> header_;
  std::vector<std::string> root_columns_, free_joints_;
  std::vector<std::vector<std::string>> free_columns_;  // by joint
  std::map<std::string, std::size_t> column_of_name_;
  std::vector<int> target_of_column_;
  std::size_t targets_ = 0;
  std::array<bool, kKinds.size()> has_kind_{};
  MotionTable table_;
};

}  // namespace

MotionTable readMotionText(TextSource& text, const std::string& name,
                           const std::function<std::string(const std::string&)>& rename,
                           const JointChoice& choose, std::vector<std::string>* unused,
                           std::vector<std::size_t>* lines) {
  return CsvReader(text, name, rename).read(choose, unused, lines);
}

MotionTable readMotionCsv(const std::string& path, const std::vector<std::string>& joints,
                          std::vector<std::string>* unused, std::vector<std::size_t>* lines) {
  TextFile file(path);
  return CsvReader(file, path).read(joints, unused, lines);
}

MotionTable readMotionCsv(const std::string& path, const JointChoice& choose,
                          std::vector<std::string>* unused, std::vector<std::size_t>* lines) {
  TextFile file(path);
  return readMotionText(file, path, {}, choose, unused, lines);
}

MotionTable readMotionCsv(std::istream& stream, const std::string& name,
                          const std::vector<std::string>& joints, std::vector<std::string>* unused,
                          std::vector<std::size_t>* lines) {
  StreamSource text(stream, name);
  return CsvReader(text, name).read(joints, unused, lines);
}

}  // namespace virtual_work_dynamics
