#pragma once

#include <string>
#include <vector>

#include "bag/bag_reader.h"
#include "base/text_file.h"
#include "offline/motion_file.h"
#include "offline/motion_source.h"

namespace virtual_work_dynamics {

/// Reads a motion from the joint states of a bag: a row for each message that has all joints that
/// `choose` takes, in the order of their stamps. Says on standard error which messages are not
/// used, and what is wrong with the bag.
/// @param unused receives the joints that were not chosen
/// @throws FileError, one line, when the bag, its topic or its messages cannot be used. Exceptions
///   of `choose` propagate.
MotionFile readBagMotion(const MotionSource& source, const JointChoice& choose,
                         std::vector<std::string>& unused);

/// As readBagMotion(), from a text that StateCsv reads; it has no topics to choose from.
MotionFile readStateCsv(TextSource& text, const MotionSource& source, const JointChoice& choose,
                        std::vector<std::string>& unused);

/// Says in a line on standard error what is wrong with a bag that has been read, if anything is.
void warnOfDamage(const BagReader& reader);

}  // namespace virtual_work_dynamics
