#pragma once

#include <string>
#include <vector>

#include "generate/program.h"
#include "generate/recorder.h"

namespace virtual_work_dynamics {

/// What a source is made of.
struct SourceContent {
  std::string name;  ///< an identifier, with which all names begin
  std::string head;  ///< the comment at the top
  const RecordedPlan& recording;
  const Program& program;
};

/// The text of the functions that a header declares.
std::string cSource(const SourceContent& content);

/// The declarations of those functions, with what they do.
std::string cDeclarations(const std::string& name, const RecordedPlan& recording);

}  // namespace virtual_work_dynamics
