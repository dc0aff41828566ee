#include "estimator/report_streams.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kQuickSeconds = 4;
constexpr double kJitter = 1e-4;  // s

/// What differs from a stream of the grid.
std::vector<StreamSpec> hardKinds() {
  std::vector<StreamSpec> kinds(6);
  kinds[0].group = "uneven";
  kinds[0].uneven = 0.8;
  kinds[1].group = "white";
  kinds[1].white = 3;
  kinds[2].group = "dropped";
  kinds[2].dropped = 0.05;
  kinds[3].group = "fourier";
  kinds[3].motion = MotionKind::kFourier;
  kinds[4].group = "trapezoids";
  kinds[4].motion = MotionKind::kTrapezoids;
  kinds[5].group = "still";
  kinds[5].still = true;
  return kinds;
}

}  // namespace

std::vector<StreamSpec> gridStreams(bool quick) {
  std::vector<StreamSpec> streams;
  for (const int rate : {125, 500, 1000, 4000})
    for (const double quantum : {1e-5, 1e-4, 1e-3})
      for (const VelocityKind velocity : {VelocityKind::kNone, VelocityKind::kGood})
        for (const double jitter : {0.0, kJitter}) {
          if (quick && (rate > 500 || quantum != 1e-4 || jitter > 0)) continue;
          StreamSpec spec;
          spec.rate = rate;
          spec.quantum = quantum;
          spec.velocity = velocity;
          spec.jitter = jitter;
          if (quick) spec.seconds = kQuickSeconds;
          streams.push_back(spec);
        }
  return streams;
}

std::vector<StreamSpec> hardStreams(bool quick) {
  std::vector<StreamSpec> streams;
  for (const StreamSpec& kind : hardKinds())
    for (const int rate : {125, 1000})
      for (const double quantum : {1e-5, 1e-3})
        for (const VelocityKind velocity : {VelocityKind::kNone, VelocityKind::kGood}) {
          if (quick && (rate > 125 || quantum > 1e-5 || velocity != VelocityKind::kNone)) continue;
          StreamSpec spec = kind;
          spec.rate = rate;
          spec.quantum = quantum;
          spec.velocity = velocity;
          if (quick) spec.seconds = kQuickSeconds;
          streams.push_back(spec);
        }
  return streams;
}

std::vector<StreamSpec> wrongVelocityStreams(bool quick) {
  std::vector<StreamSpec> streams;
  for (const VelocityKind velocity :
       {VelocityKind::kZero, VelocityKind::kDegrees, VelocityKind::kTooLarge, VelocityKind::kNoisy})
    for (const int rate : {125, 1000})
      for (const double quantum : {1e-5, 1e-4, 1e-3}) {
        if (quick && (rate > 125 || quantum != 1e-4)) continue;
        StreamSpec spec;
        spec.group = "wrong";
        spec.rate = rate;
        spec.quantum = quantum;
        spec.velocity = velocity;
        if (quick) spec.seconds = kQuickSeconds;
        streams.push_back(spec);
      }
  return streams;
}

}  // namespace virtual_work_dynamics
