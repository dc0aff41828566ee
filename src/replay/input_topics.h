#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bag/bag_records.h"
#include "offline/motion_source.h"

namespace virtual_work_dynamics {

/// The topics that a node would subscribe to, as a recording has them.
class InputTopics {
 public:
  /// @param source of the recording   @param node whose topics they are   @param remap other names
  ///   for topics of the node, as rosrun takes them; an empty name: the topic is not read
  /// @throws FileError as BagReader.
  InputTopics(const MotionSource& source, std::string node,
              std::vector<std::pair<std::string, std::string>> remap);

  /// The topic that stands for one of the node's in the recording; empty where there is none. One
  /// that may be missing and is of another type is left alone, with a note on standard error.
  /// @param name like `odom`, or `~gravity` of one below the node's own name
  /// @param type and version as connections say them
  /// @param purpose what it is needed for; empty: it may be missing
  /// @throws FileError, one line, when it is missing or of another type though it is needed, or
  ///   UsageError when it is not to be read though it is needed.
  std::string find(const std::string& name, const std::string& type, const std::string& md5sum,
                   const std::string& purpose = "");
  /// Whether there is a topic of a type.
  bool hasType(std::string_view type) const;
  /// @throws UsageError when a name was remapped that was never asked for.
  void refuseUnused() const;

 private:
  bool has(const std::string& topic) const;
  std::string mismatch(const std::string& name, const std::string& topic, const std::string& type,
                       const std::string& md5sum) const;

  const std::string source_, node_;
  const std::vector<std::pair<std::string, std::string>> remap_;
  std::vector<std::string> asked_;
  std::vector<BagConnection> connections_;
  std::string damage_;
};

}  // namespace virtual_work_dynamics
