#include "cores.h"

#include <sched.h>

namespace virtual_work_dynamics {
namespace {

cpu_set_t coresAtStart() {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  sched_getaffinity(0, sizeof(cores), &cores);
  return cores;
}

const cpu_set_t kCoresAtStart = coresAtStart();

}  // namespace

int stayOnOneCore() {
  // The last one: systems give the first more than its share of interrupts.
  for (int core = CPU_SETSIZE - 1; core >= 0; --core) {
    if (!CPU_ISSET(core, &kCoresAtStart)) continue;
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(core, &one);
    return sched_setaffinity(0, sizeof(one), &one) == 0 ? core : -1;
  }
  return -1;
}

void useAllCores() {
  sched_setaffinity(0, sizeof(kCoresAtStart), &kCoresAtStart);
}

}  // namespace virtual_work_dynamics
