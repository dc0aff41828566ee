#pragma once

#include <string>

namespace virtual_work_dynamics {

/// A text as JSON writes it: in quotes, with what has no place between them escaped.
std::string jsonText(const std::string& text);

}  // namespace virtual_work_dynamics
