/* A linkage without any library: the torque that turns a slider-crank at a constant rate, by code that was
 * generated of a scene with a closed loop.
 *
 *   06_generated_loop      (examples/CMakeLists.txt generates generated_crank.h and .c)
 *
 * The generated function takes the motion of all joints; how the loop is closed is written here in closed
 * form. Its status says whether forces are determined: they would not be at the dead centres if the slider
 * drove the crank. */
#include <generated_crank.h>
#include <math.h>
#include <stdio.h>

enum { N = GENERATED_CRANK_COORDINATES };
static const double kCrank = 0.10, kRod = 0.30; /* lengths of the description, m */

/* Rod and slider of a crank that turns at a constant rate, rad/s. */
static void follow(double angle, double rate, double *q, double *qd, double *qdd) {
  const int crank = GENERATED_CRANK_Q_CRANK_JOINT, rod = GENERATED_CRANK_Q_ROD_JOINT;
  const int slider = GENERATED_CRANK_Q_SLIDER_JOINT;
  /* The rod's angle r from the slider's axis: rod sin r + crank sin angle = 0, and derivatives. */
  const double x = kCrank * cos(angle), y = kCrank * sin(angle);
  const double r = -asin(y / kRod), along = kRod * cos(r), across = kRod * sin(r);
  const double rd = -x * rate / along;
  const double rdd = (y * rate * rate + across * rd * rd) / along;
  q[crank] = angle;
  qd[crank] = rate;
  qdd[crank] = 0.0;
  q[rod] = r - angle; /* the joint's is that between crank and rod */
  qd[rod] = rd - rate;
  qdd[rod] = rdd;
  q[slider] = x + along;
  qd[slider] = -y * rate - across * rd;
  qdd[slider] = -x * rate * rate - along * rd * rd - across * rdd;
}

int main(void) {
  const double turn = 6.283185307179586, rate = 20.0;
  double q[N], qd[N], qdd[N], effort[N], reactions[6 * GENERATED_CRANK_REACTIONS];
  const double *const pin = reactions + 6 * GENERATED_CRANK_R_WRIST_PIN;
  int i;
  for (i = 0; i < 24; ++i) {
    follow(turn * i / 24, rate, q, qd, qdd);
    if (generated_crank_compute(q, qd, qdd, effort, reactions) != 0) {
      fprintf(stderr, "forces are not determined, or hardly\n");
      return 1;
    }
    printf("%3d degrees: torque %9.6f N m, the pin carries %9.6f N\n", 15 * i,
           effort[GENERATED_CRANK_EFFORT_CRANK_JOINT], sqrt(pin[0] * pin[0] + pin[1] * pin[1]));
  }
  return 0;
}
