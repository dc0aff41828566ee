// A robot description from bytes, compiled and computed once in the position zero.
#include "fuzz_target.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/urdf_reader.h"

using namespace virtual_work_dynamics;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  acceptOrRefuse([&] {
    const Mechanism mechanism = readUrdf(textOf(data, size));
    const Dynamics dynamics(mechanism, Scene());
    Dynamics::Workspace workspace = dynamics.makeWorkspace();
    dynamics.compute(Motion(dynamics.coordinates()), workspace);
    if (workspace.results().effort.size() != dynamics.coordinates()) failFuzz("number of efforts");
  });
  return 0;
}
