#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace virtual_work_dynamics {

/// What became of the content of a chunk.
enum class Decompressed {
  kWhole,
  kCut,     ///< the compressed bytes end too soon; what they hold is there
  kBroken,  ///< they are not what a compressor wrote
  kUnknown  ///< this build does not read such a compression
};

/// Decompresses the data of a chunk: `none`, `bz2`, or `lz4`.
/// @param compression as the field of that name has it
/// @param size of the content
/// @param content receives it; its memory is used again
Decompressed decompressChunk(std::string_view compression, std::string_view data, std::size_t size,
                             std::vector<char>& content);

}  // namespace virtual_work_dynamics
