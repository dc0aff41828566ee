#pragma once

#include <vector>

#include "estimator/encoder_stream.h"

namespace virtual_work_dynamics {

/// Four rates, three quanta, with and without velocities, with stamps that jitter and that do not.
/// @param quick four of the 48 streams, of half the length.
std::vector<StreamSpec> gridStreams(bool quick);

/// Streams that fool simple answers: truly uneven sampling, noise of several quanta, dropped rows,
/// slow sines that move from the start, trapezoids, and joints that stand still.
std::vector<StreamSpec> hardStreams(bool quick);

/// Streams with wrong velocities.
std::vector<StreamSpec> wrongVelocityStreams(bool quick);

}  // namespace virtual_work_dynamics
