// Prints the effort of the first joint of a generated robot that rests at zero, and of one that
// speeds up.
#include <downstream_generated.h>

#include <cstdio>

int main() {
  const int n = DOWNSTREAM_GENERATED_COORDINATES;
  double q[n] = {}, qd[n] = {}, qdd[n] = {}, effort[n];
  downstream_generated_compute(q, qd, qdd, effort);
  std::printf("%.9f", effort[0]);
  qdd[0] = 1;
  downstream_generated_compute(q, qd, qdd, effort);
  std::printf(" %.9f\n", effort[0]);
}
