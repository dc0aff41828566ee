#include "bag/chunk_compression.h"

#include <algorithm>

#ifdef VWD_HAS_BZ2
#include <bzlib.h>
#endif
#ifdef VWD_HAS_LZ4
#include <lz4frame.h>
#endif

namespace virtual_work_dynamics {
namespace {

// Content grows by so much, as a size that a damaged file says may be anything.
constexpr std::size_t kPiece = std::size_t{1} << 20;

// Makes room for more content behind the `filled` bytes; how much there is then.
std::size_t makeRoom(std::size_t filled, std::size_t size, std::vector<char>& content) {
  const std::size_t wanted = std::min(filled + kPiece, size);
  if (content.size() < wanted) content.resize(wanted);
  return std::min(content.size(), size) - filled;
}

Decompressed finish(bool at_end, bool broken, std::size_t filled, std::size_t size,
                    std::vector<char>& content) {
  content.resize(filled);
  if (broken || (at_end && filled != size)) return Decompressed::kBroken;
  return at_end ? Decompressed::kWhole : Decompressed::kCut;
}

#ifdef VWD_HAS_BZ2
Decompressed decompressBz2(std::string_view data, std::size_t size, std::vector<char>& content) {
  bz_stream stream = {};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) return Decompressed::kBroken;
  stream.next_in = const_cast<char*>(data.data());  // bzlib does not write there
  stream.avail_in = static_cast<unsigned>(data.size());
  std::size_t filled = 0;
  int result = BZ_OK;
  while (result == BZ_OK) {
    char beyond = 0;  // where the content is complete, the end of the stream is still to be read
    const std::size_t room = makeRoom(filled, size, content);
    stream.next_out = room > 0 ? content.data() + filled : &beyond;
    stream.avail_out = room > 0 ? static_cast<unsigned>(room) : 1;
    const unsigned before = stream.avail_in, out = stream.avail_out;
    result = BZ2_bzDecompress(&stream);
    filled += out - stream.avail_out;
    if (filled > size) result = BZ_DATA_ERROR;
    if (result == BZ_OK && before == stream.avail_in && out == stream.avail_out) break;
  }
  BZ2_bzDecompressEnd(&stream);
  filled = std::min(filled, size);
  return finish(result == BZ_STREAM_END, result != BZ_OK && result != BZ_STREAM_END, filled, size,
                content);
}
#endif

#ifdef VWD_HAS_LZ4
Decompressed decompressLz4(std::string_view data, std::size_t size, std::vector<char>& content) {
  LZ4F_decompressionContext_t context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION))) {
    return Decompressed::kBroken;
  }
  std::size_t filled = 0, left = 1;  // left: 0 at the end of the frame
  bool broken = false;
  while (left != 0 && !broken) {
    char beyond = 0;
    std::size_t out = makeRoom(filled, size, content);
    const bool complete = out == 0;
    std::size_t in = data.size();
    left = LZ4F_decompress(context, complete ? &beyond : content.data() + filled, &out, data.data(),
                           &in, nullptr);
    broken = LZ4F_isError(left) != 0 || (complete && out > 0);
    data.remove_prefix(in);
    if (!broken) filled += out;
    if (in == 0 && out == 0) break;
  }
  LZ4F_freeDecompressionContext(context);
  return finish(left == 0, broken, filled, size, content);
}
#endif

}  // namespace

Decompressed decompressChunk(std::string_view compression, std::string_view data, std::size_t size,
                             std::vector<char>& content) {
  if (compression == "none") {
    content.assign(data.begin(), data.end());
    return finish(data.size() >= size, false, data.size(), size, content);
  }
#ifdef VWD_HAS_BZ2
  if (compression == "bz2") return decompressBz2(data, size, content);
#endif
#ifdef VWD_HAS_LZ4
  if (compression == "lz4") return decompressLz4(data, size, content);
#endif
  return Decompressed::kUnknown;
}

}  // namespace virtual_work_dynamics
