#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "offline/motion_file.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// The command line contradicts itself or asks for something that does not exist.
class UsageError : public Error {
 public:
  using Error::Error;
};

struct TaskInputs;

/// How efforts and reactions are computed.
enum class Method {
  kVirtualWork,
  kLagrange  ///< Lagrange's equations, in long double
};

/// How far a motion may violate the loops of a mechanism, relative, unless the command line says
/// it.
constexpr double kLoopTolerance = 1e-6;

/// The contents of the command line of inverse_dynamics_offline. Texts that are not given are
/// empty.
struct Arguments {
  std::string urdf;
  std::string rosparam;  ///< dump of parameters, of which description and scene may be
  MotionSource motion;
  std::string scene;
  std::string output;                      ///< empty: standard output
  std::string report;                      ///< folder of the load report; empty: none
  std::optional<Eigen::Vector3d> gravity;  ///< m/s^2, inertial axes; replaces the scene's
  bool inertial_axes = false;              ///< reactions in inertial axes rather than root axes
  bool child_axes = false;                 ///< reactions in child link axes rather than root axes
  std::optional<ReactionSelection> reactions;  ///< replaces the scene's choice
  std::vector<std::string> reaction_names;     ///< names for ReactionSelection::kNamed
  bool no_efforts = false;
  std::string generate;                    ///< source file to write; empty: none
  bool copy_input = false;                 ///< to a bag that is written
  std::string node = "/inverse_dynamics";  ///< whose topics and parameters are read and written
  std::string root_source;                 ///< as ~root/source; empty: as the parameters say
  /// Topics that are read from a bag in place of the node's.
  std::vector<std::pair<std::string, std::string>> remap;
  Method method = Method::kVirtualWork;
  bool certificates = false;
  std::string regressor;                ///< folder to write the regressor to; empty: none
  std::vector<std::string> parameters;  ///< of the regressor: joints, links or names of links
  bool deviations = false;
  bool positions = false;
  bool effort_limits = false;  ///< whether efforts beyond the description's limits are listed
  bool residuals = false;      ///< of measured efforts, which are in the motion unless…
  std::optional<double> observer_gain;   ///< 1/s; none: no momentum observer
  MotionSource measured;                 ///< …they are from here
  std::optional<double> deviation_warn;  ///< over the effort's rms; none: kDeviationWarn
  int threads = 1;
  std::optional<double> loop_tolerance;  ///< relative; none: kLoopTolerance
  RecordingOptions recording;
  bool check = false;
  bool explain = false;
  bool help = false;  ///< words after --help or --version are ignored
  bool version = false;
  std::shared_ptr<const TaskInputs> inputs{};  ///< once they are read; see readTaskInputs()

  /// Where measured efforts are read from.
  MotionSource measuredSource() const;
  /// Whether the output is a bag, by its name.
  bool toBag() const;
  /// Whether the output is an .npz, by its name.
  bool toNpz() const;
};

/// Reads a command line without the program's name, with `--option value` or `--option=value`.
/// @throws UsageError, one line naming the option.
Arguments parseArguments(const std::vector<std::string>& words);

/// The text of --help.
std::string helpText();

}  // namespace virtual_work_dynamics
