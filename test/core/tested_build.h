#pragma once

namespace virtual_work_dynamics {

// The build that tests are linked to: tests are compiled once for several builds.

/// Path of the offline tool.
extern const char* const kOfflineTool;

/// The package's folder, and that of data that is not part of it.
extern const char* const kSourceFolder;
extern const char* const kSharedData;

/// Whether the library was compiled with sanitizers.
extern const bool kSanitized;

}  // namespace virtual_work_dynamics
