/* A controller without any library: efforts by code that was generated for one robot and one scene.
 *
 *   06_generated      (examples/CMakeLists.txt generates generated_arm.h and .c from the description)
 *
 * The loop is that of a microcontroller: no allocation, no names, no files. */
#include <generated_arm.h>
#include <math.h>
#include <stdio.h>

enum { N = GENERATED_ARM_COORDINATES };

/* A joint swings from 0 to 1 rad and back in 4 s. */
static void swing(double t, double *q, double *qd, double *qdd) {
  const double w = 1.5707963267948966;
  *q = 0.5 - 0.5 * cos(w * t);
  *qd = 0.5 * w * sin(w * t);
  *qdd = 0.5 * w * w * cos(w * t);
}

/* What encoders say: here, that the arm lags behind by a hundredth of a radian. */
static double encoder(double wanted) { return wanted - 0.01; }

int main(void) {
  static const char *const names[N] = GENERATED_ARM_COORDINATE_NAMES;
  const double stiffness = 200.0;
  double q[N], qd[N], qdd[N], measured[N], effort[N], reactions[6 * GENERATED_ARM_REACTIONS];
  int tick, i;
  for (tick = 0; tick <= 4000; ++tick) { /* a millisecond each */
    const double t = 0.001 * tick;
    for (i = 0; i < N; ++i) {
      q[i] = qd[i] = qdd[i] = 0.0;
      measured[i] = encoder(q[i]);
    }
    i = GENERATED_ARM_Q_JOINT_2;
    if (t > 0.0 && t < 4.0) swing(t, &q[i], &qd[i], &qdd[i]);
    measured[i] = encoder(q[i]);

    /* The model's effort of the wanted motion, and a spring towards it. */
    generated_arm_compute(q, qd, qdd, effort, reactions);
    for (i = 0; i < N; ++i) effort[i] += stiffness * (q[i] - measured[i]);

    if (tick % 1000 != 0) continue;
    printf("%d s: efforts [N m]", tick / 1000);
    for (i = 0; i < N; ++i) printf(" %s %.6f", names[i], effort[i]);
    printf("\n     the column carries %.6f N\n", reactions[6 * GENERATED_ARM_R_JOINT_1 + 2]);
  }
  return 0;
}
