#pragma once

#include <string>
#include <vector>

namespace virtual_work_dynamics {

/// What a reader has to do with a description.
enum class Verdict { kAccept, kRefuse, kEither };

/// A description like those in public, with faults like theirs.
struct DirtyDescription {
  std::string urdf;
  std::vector<std::string> faults;  ///< names of the faults
  Verdict verdict = Verdict::kAccept;
};

/// Makes the description of a seed: a robot of a few to many links in one of several styles, with
/// none to four faults.
DirtyDescription dirtyDescription(unsigned seed);

/// The names of all faults.
std::vector<std::string> dirtyFaults();

}  // namespace virtual_work_dynamics
