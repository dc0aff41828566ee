#pragma once

#include "offline/arguments.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/request.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// @throws UsageError when --generate names no source file of C or C++.
void requireSourceName(const Arguments& arguments);

/// The header that is written beside the source of --generate.
std::string generatedHeader(const Arguments& arguments);

/// Writes the code of a robot and scene to the file of --generate, and its header beside it.
/// @throws Error as generateCode() does, FileError when a file cannot be written.
void writeGeneratedFiles(const Arguments& arguments, const Mechanism& mechanism, const Scene& scene,
                         const Request& request);

}  // namespace virtual_work_dynamics
