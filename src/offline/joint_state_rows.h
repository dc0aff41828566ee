#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bag/joint_state_bytes.h"
#include "offline/joint_renaming.h"
#include "virtual_work_dynamics/motion_table.h"

namespace virtual_work_dynamics {

/// Collects the joint states of a recording, and makes a table of them once it is known which
/// joints are wanted.
class JointStateRows {
 public:
  /// @param row_name what is counted, for messages: "message", "line"
  /// @param rename for the names of the joints; must outlive it
  JointStateRows(const char* row_name, const JointRenaming& rename)
      : row_name_(row_name), rename_(rename) {}

  const char* rowName() const { return row_name_; }

  /// Takes a message, or notes why it cannot be used.
  /// @param number of the message in the recording, from 1
  void add(const JointStateContent& message, std::size_t number);
  /// Takes note of a message that is not one.
  void refuse(std::size_t number, const std::string& why);

  /// The joints of all messages, in the order in which they came.
  const std::vector<std::string>& joints() const { return joints_; }

  /// What became of the messages when a table was made.
  struct Table {
    MotionTable motion;                   ///< times from the first stamp on
    std::vector<std::int64_t> stamps_ns;  ///< by row
    std::vector<std::size_t> messages;    ///< by row: number of the message
    std::size_t without_any = 0;          ///< messages that have none of the joints
    std::size_t without_some = 0;         ///< messages that have some of the joints, but not all
    std::size_t repeated = 0;             ///< messages whose stamp another one had before
    bool velocities_left_out = false;     ///< because not every row has finite ones
  };
  /// Makes a table of the messages that have all of these joints, in the order of their stamps.
  /// @param joints in the order of the columns
  /// @throws Error, to stand behind the path, when no message has all of them, or when stamps go
  ///   back as those of two recordings do.
  Table make(const std::vector<std::string>& joints) const;

  std::size_t refused() const { return refused_; }
  /// Which was refused first, and why: "message 7: 3 names but 2 positions".
  const std::string& refusal() const { return refusal_; }

 private:
  struct Row {
    std::int64_t stamp_ns;
    std::size_t message;
  };
  /// Messages with one list of names.
  struct Layout {
    std::vector<std::string> given;  // names in the messages
    std::vector<std::string> names;  // as renamed
    std::vector<Row> rows;
    std::vector<double> positions, velocities;  // row after row; not finite: not given
  };
  /// Where the values of a row of the table are.
  struct Place {
    Row row;
    const Layout* layout;
    const std::vector<std::size_t>* columns;  // of the joints
    std::size_t index;                        // of the row in the layout
  };

  std::optional<std::size_t> layoutOf(const std::vector<std::string>& given, std::size_t number);
  std::string missing(const std::vector<std::string>& joints) const;
  static void fill(const std::vector<Place>& places, Table& table);

  const char* row_name_;
  const JointRenaming& rename_;
  std::vector<Layout> layouts_;
  std::size_t latest_ = 0;
  std::vector<std::string> joints_;
  std::size_t refused_ = 0;
  std::string refusal_;
};

}  // namespace virtual_work_dynamics
