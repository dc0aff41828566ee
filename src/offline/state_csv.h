#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "bag/joint_state_bytes.h"
#include "base/text_file.h"
#include "motion/csv_lines.h"

namespace virtual_work_dynamics {

/// Reads joint states that other programs wrote as CSV: `rostopic echo -p` of a topic of
/// sensor_msgs/JointState, whose rows are messages, and PlotJuggler, whose columns are
/// `__time,<topic>/<joint>/position` and so on, with empty cells where a series has no value.
class StateCsv {
 public:
  /// Whether a text that begins so is such a CSV.
  static bool isBegunBy(std::string_view text);

  /// Reads the header. @param name of the text, for messages; it must outlive this
  /// @throws FileError naming the line.
  StateCsv(TextSource& text, const std::string& name);

  /// Reads the next row that has a position; false at the end. Velocities and efforts that it lacks
  /// are not finite, or left out for all joints.
  /// @throws FileError naming line and column of a cell that is not a number, or a row of a wrong
  ///   length.
  bool next(JointStateContent& content);
  /// Its line.
  std::size_t line() const { return lines_.number(); }

 private:
  /// What a column of PlotJuggler holds.
  struct Series {
    int joint = -1;  ///< in joints_; negative: the column is not used
    int kind = 0;    ///< 0: position, 1: velocity, 2: effort
  };

  [[noreturn]] void refuse(const std::string& problem) const;
  void split(std::string_view line);
  double number(std::size_t column) const;
  void readSeries();
  void takeEchoed(JointStateContent& content) const;
  bool takeSeries(JointStateContent& content) const;

  CsvLines lines_;
  const std::string& name_;
  std::vector<std::string> cells_;  // of the line
  bool echoed_ = false;             // by rostopic
  bool has_velocities_ = false;     // rostopic
  bool has_efforts_ = false;        // rostopic
  std::vector<Series> series_;      // PlotJuggler, by column
  std::vector<std::string> joints_;
};

}  // namespace virtual_work_dynamics
