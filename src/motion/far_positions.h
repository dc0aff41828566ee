#pragma once

namespace virtual_work_dynamics {

/// Samples before a far one that it is judged by, and those from it on that are needed at most.
constexpr int kBeforeFar = 9;
constexpr int kMostFar = 7;

/// What a position that is far from the one before it turns out to be.
enum class FarVerdict {
  kOpen,    ///< later samples have to tell
  kMotion,  ///< the joint moves so
  kAlone,   ///< it and perhaps the next one stand alone: those after them go on as before
  kJump     ///< another motion begins with it: those after it stay there
};

struct FarFinding {
  FarVerdict verdict = FarVerdict::kOpen;
  int alone = 0;  ///< samples that stand alone
};

/// Whether a step of the position is so unlike the one before that a joint cannot have made it
/// unless it goes on like that: then judgeFar() tells.
/// @param step rad or m, less what the step before lets expect   @param time s that it took @param
/// interval s, usual time of a step
/// @param least rad or m, standard deviation that no position can be better than
/// @param deviation rad or m, standard deviation of positions as far as it is known
bool isFar(double step, double time, double interval, double least, double deviation);

/// Judges a position that isFar() by the steps before and after it: those of a motion are not so
/// unlike each other. Does not allocate.
/// @param times s   @param positions rad or m, both of `count` samples, oldest first
/// @param first the far sample; 1 … kBeforeFar   @param count at most kBeforeFar + kMostFar
/// @param interval s, usual time of a step
FarFinding judgeFar(const double* times, const double* positions, int first, int count,
                    double interval);

}  // namespace virtual_work_dynamics
