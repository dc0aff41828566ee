#pragma once

#include <string>

#include "offline/arguments.h"

namespace virtual_work_dynamics {

/// Makes the folder of --report. @throws FileError when it cannot be made.
void makeReportFolder(const Arguments& arguments);

/// Makes the report of the results that were written, by load_report.py.
/// @param mechanism what mechanismJson() says
/// @throws FileError when the program is not found or fails; it has then said why.
void makeLoadReport(const Arguments& arguments, const std::string& mechanism);

}  // namespace virtual_work_dynamics
