#pragma once

#include <vector>

namespace virtual_work_dynamics {

/// Times at which an even clock would have taken the samples that carry these stamps: steps of one
/// interval, or of several where rows are missing, with the drift that is left in the stamps.
/// Whether the samples were taken so is for whoever asks to judge: stamps may be late by chance, or
/// tell the truth.
/// @param stamps s, increasing.
/// @returns as many times, s; none where the stamps are even already or follow no clock.
std::vector<double> evenTimes(const std::vector<double>& stamps);

/// Usual time from one stamp to the next, s: the median; 1 for fewer than two.
double usualInterval(const std::vector<double>& stamps);

}  // namespace virtual_work_dynamics
