#pragma once

#include <string>

#include "offline/arguments.h"
#include "offline/result_writer.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Name of the file in an .npz that has the text of mechanismJson().
constexpr char kMechanismFile[] = "mechanism.json";

/// What a table of results does not say of the joints that its columns belong to, as JSON for
/// scripts/load_report.py: types, axes in those of the reactions, units, limits, and the columns
/// that say how they move.
std::string mechanismJson(const Arguments& arguments, const Mechanism& mechanism,
                          const Scene& scene, const Dynamics& dynamics, const Columns& columns);

}  // namespace virtual_work_dynamics
