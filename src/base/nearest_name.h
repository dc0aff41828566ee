#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace virtual_work_dynamics {

/// How many letters have to be inserted, left out, exchanged, or swapped with their neighbour, to
/// make one text of another (Damerau and Levenshtein's, no letter touched twice); `most` + 1 when
/// they are more than `most`.
std::size_t editDistance(std::string_view a, std::string_view b, std::size_t most);

/// The known name that a misspelt one was hardly meant to differ from: the nearest within a third
/// of its length, or the only one that contains it. Empty when there is none. Names that differ in
/// numbers only, as joint_1 and joint_7, are not taken for one another.
std::string nearestName(const std::string& name, const std::vector<std::string>& known);

/// What helps a user who gave a name that is not known, to stand at the end of a message:
/// "; did you mean 'x'?", or which are known: "; known are 'a', 'b' and 3 more".
std::string nameHelp(const std::string& name, const std::vector<std::string>& known);

}  // namespace virtual_work_dynamics
