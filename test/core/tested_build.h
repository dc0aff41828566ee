#pragma once

namespace virtual_work_dynamics {

// What tests are linked to: they are compiled once for several builds.

/// Path of the offline tool.
extern const char* const kOfflineTool;

/// Whether the library was compiled with sanitizers.
extern const bool kSanitized;

}  // namespace virtual_work_dynamics
