// An .npz from bytes: its arrays, and the motion that they make as columns.
#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "fuzz_folder.h"
#include "fuzz_target.h"
#include "motion/motion_text.h"
#include "npz/npz_reader.h"
#include "offline/npz_motion.h"

using namespace virtual_work_dynamics;

namespace {

constexpr std::size_t kAtOnce = 1000;

void readArrays(NpzReader& file) {
  std::vector<double> values;
  std::vector<std::int64_t> times;
  for (std::size_t i = 0; i < file.names().size(); ++i) {
    for (std::size_t row = 0; row < file.rows(); row += kAtOnce) {
      const std::size_t count = std::min(kAtOnce, file.rows() - row);
      file.read(i, row, count, values);
      if (values.size() != count) failFuzz("values are missing");
      if (!file.areTimes(i)) continue;
      file.readTimes(i, row, count, times);
      if (times.size() != count) failFuzz("times are missing");
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const FuzzFolder folder;
  const std::string path = folder.file("in.npz");
  std::ofstream(path, std::ios::binary) << textOf(data, size);
  acceptOrRefuse([&] {
    NpzReader file(path);
    // Each array takes as many bytes of the file as it has values, so that there are not many.
    if (file.rows() > size) failFuzz("more rows than bytes");
    readArrays(file);
  });
  acceptOrRefuse([&] {
    NpzMotion arrays(path);
    std::vector<std::size_t> lines;
    const auto all = [](const std::vector<std::string>& joints) { return joints; };
    const MotionTable table = readMotionText(arrays, path, {}, all, nullptr, &lines);
    if (lines.size() != table.times.size()) failFuzz("lines and rows differ");
    if (!table.positions.allFinite()) failFuzz("a position that is not finite");
  });
  return 0;
}
