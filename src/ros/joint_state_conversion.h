#pragma once

#include <sensor_msgs/JointState.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "ros/rejection.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// The part of a joint state that belongs to generalized coordinates and given lengths, whose
/// indices go on behind those, as MotionEstimator takes it. Its pointers are valid until the next
/// call of the conversion that made it.
struct JointSample {
  std::int64_t stamp_ns = 0;
  int count = 0;
  const int* coordinates = nullptr;
  const double* q = nullptr;         ///< rad or m
  const double* qd = nullptr;        ///< rad/s or m/s, NaN where it is not finite; null: not given
  const double* effort = nullptr;    ///< N m or N, as measured; null: not given
  bool velocity_not_finite = false;  ///< whether some velocity is not, so that it is not used
  /// Text about the first velocity of each joint that is not finite; else empty.
  std::string velocity_problem;
  /// Text about the first position of each mimic joint that disagrees with its master; else empty.
  std::string mimic_disagreement;
};

/// Converts joint states by joint name into samples by generalized coordinate. Names are looked up
/// when a list of names is new; a few lists are remembered, as several drivers may publish in turn.
class JointStateConversion {
 public:
  /// @param lengths names of those that are given, see givenLengths()
  explicit JointStateConversion(const Mechanism& mechanism,
                                const std::vector<std::string>& lengths = {});

  /// Checks and converts a message. Joints that the robot does not have and mimic joints are
  /// ignored. Allocates only for new lists of names, a rejection or a disagreement.
  /// @returns why the message is to be dropped, or nothing.
  std::optional<Rejection> convert(const sensor_msgs::JointState& message, JointSample& sample);

 private:
  struct MimicColumn {
    int column;
    int master_column;
    int joint;
  };
  /// The columns of a message with a certain list of names.
  struct Layout {
    std::vector<std::string> names;
    std::vector<int> columns;      ///< columns of the message that are coordinates
    std::vector<int> coordinates;  ///< coordinates in the order of `columns`
    std::vector<MimicColumn> mimics;
    std::optional<Rejection> rejection;
  };
  static constexpr std::size_t kLayouts = 8;

  Layout& layoutOf(const std::vector<std::string>& names);
  void resolve(const std::vector<std::string>& names, Layout& layout) const;
  void resolveMimics(Layout& layout) const;
  std::optional<Rejection> gatherPositions(const Layout& layout,
                                           const std::vector<double>& positions);
  void gatherVelocities(const Layout& layout, const std::vector<double>& velocities,
                        JointSample& sample);
  void checkMimics(Layout& layout, const std::vector<double>& positions, std::string& disagreement);

  const Mechanism& mechanism_;
  std::vector<std::string> names_;  // of coordinates, then lengths
  std::unordered_map<std::string, int> coordinate_of_;
  std::array<Layout, kLayouts> layouts_;
  std::size_t latest_ = 0;
  std::size_t next_ = 0;
  std::vector<double> q_;
  std::vector<double> qd_;
  std::vector<double> effort_;
  std::vector<char> velocity_reported_;
  std::vector<char> mimic_reported_;
};

}  // namespace virtual_work_dynamics
