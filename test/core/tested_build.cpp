#include "tested_build.h"

namespace virtual_work_dynamics {

const char* const kOfflineTool = OFFLINE_TOOL;
const char* const kSourceFolder = VWD_SOURCE_DIR;
const char* const kSharedData = VWD_SHARED_DATA;

#ifdef VWD_SANITIZED
const bool kSanitized = true;
#else
const bool kSanitized = false;
#endif

}  // namespace virtual_work_dynamics
