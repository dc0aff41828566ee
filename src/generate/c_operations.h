#pragma once

#include <string>

#include "generate/program.h"
#include "generate/recorder.h"

namespace virtual_work_dynamics {

/// Writes the operations of one part of a program as statements of C: for one sample, or for a pack
/// of samples whose numbers lie `stride` apart.
class OperationWriter {
 public:
  /// @param name with which the names of the source begin
  OperationWriter(const std::string& name, const RecordedPlan& recording, bool packs);

  /// The statements of a part, outputs and what is kept in memory included.
  std::string part(const ProgramPart& part, bool last);
  /// Statements that find the sines and cosines of the angles, and their rests: of a sample whole,
  /// of a pack of samples its angles into the array `angle`.
  std::string angles();

 private:
  void sines();
  void leaf(std::uint32_t node);
  void operation(std::uint32_t node);
  std::string spelling(const Node& node);
  std::string text(const Term& term);
  std::string selected(const std::string& by, const std::string& a, const std::string& b,
                       const std::string& then, const std::string& otherwise) const;
  std::string constant(double value) const;
  std::string element(const std::string& array, int index) const;
  void assign(const std::string& to, const std::string& value);
  void define(std::uint32_t node, const std::string& value);
  void start();

  const std::string name_, capitals_;
  const RecordedPlan& recording_;
  const bool packs_;
  std::string out_;
  std::vector<bool> defined_;
  std::vector<std::vector<const GraphOutput*>> outputs_of_;  // by node
};

}  // namespace virtual_work_dynamics
