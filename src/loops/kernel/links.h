#pragma once

#include "base/number_choices.h"
#include "loops/kernel/loop_kernel.h"
#include "tree/kernel/sine_cosine.h"
#include "tree/kernel/vec3_operations.h"

namespace virtual_work_dynamics {
namespace {  // see loop_kernel.h

// T is a number of one sample, or a pack of those of several.

template <typename T>
VWD_INLINE Vec3<T> vectorAt(const T* from) {
  return {from[0], from[1], from[2]};
}
template <typename T>
VWD_INLINE void putVector(T* to, const Vec3<T>& v) {
  to[0] = v.x;
  to[1] = v.y;
  to[2] = v.z;
}
template <typename T>
VWD_INLINE Vec3<T> zeroVector() {
  return {T(0.0), T(0.0), T(0.0)};
}
template <typename T>
VWD_INLINE Vec3<T> constantVector(const double* from) {
  return {T(from[0]), T(from[1]), T(from[2])};
}

/// Returns sum + s a.
template <typename S, typename T, typename V>
VWD_INLINE Vec3<T> addScaled(const Vec3<T>& sum, const S& s, const Vec3<V>& a) {
  return {mulAdd(s, a.x, sum.x), mulAdd(s, a.y, sum.y), mulAdd(s, a.z, sum.z)};
}
template <typename T>
VWD_INLINE T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return mulAdd(a.x, b.x, mulAdd(a.y, b.y, a.z * b.z));
}
template <typename T>
VWD_INLINE Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {subMul(a.y * b.z, a.z, b.y), subMul(a.z * b.x, a.x, b.z), subMul(a.x * b.y, a.y, b.x)};
}
/// Returns R v, where R is given by columns.
template <typename T, typename V>
VWD_INLINE Vec3<T> turnedBy(const T* R, const V& x, const V& y, const V& z) {
  return addScaled(addScaled(scaled(x, vectorAt(R)), y, vectorAt(R + 3)), z, vectorAt(R + 6));
}
template <typename T>
VWD_INLINE Vec3<T> turnedBy(const T* R, const double* v) {
  return turnedBy(R, v[0], v[1], v[2]);
}

/// Cosines, then sines, of the angles of one sample, kWidth of them at a time.
template <int kWidth>
VWD_INLINE void findAngles(const LinksView& view, const double* q, double* angles) {
  using P = Pack<double, kWidth>;
  double* const sines = angles + view.angle_count + kMostAngleLanes;
  for (int i = 0; i < view.angle_count; ++i) {
    const AngleShape& angle = view.angles[i];
    angles[i] = mulAdd(angle.multiplier, q[angle.coordinate], angle.offset);
  }
  for (int i = 0; i < view.angle_count; i += kWidth) {
    const P angle = load<P>(angles + i);
    P sine, cosine, rest(0.0);
    Lanes<double, kWidth> lanes;
    sineCosine(angle, sine, cosine, lanes);
    if (!lanes.all()) sineCosineOutside(angle, rest, sine, cosine);
    store(angles + i, cosine);
    store(sines + i, sine);
  }
}

/// Those of a pack of samples.
template <int kWidth, typename T>
VWD_INLINE void findAngles(const LinksView& view, const T* q, T* angles) {
  T* const sines = angles + view.angle_count + kMostAngleLanes;
  for (int i = 0; i < view.angle_count; ++i) {
    const AngleShape& shape = view.angles[i];
    const T angle = mulAdd(shape.multiplier, q[shape.coordinate], T(shape.offset));
    T rest(0.0);
    Lanes<double, kWidth> lanes;
    sineCosine(angle, sines[i], angles[i], lanes);
    if (!lanes.all()) sineCosineOutside(angle, rest, sines[i], angles[i]);
  }
}

/// Returns column i of the child's axes in the parent's.
template <typename T>
VWD_INLINE Vec3<T> turnedColumn(const JointShape& joint, int i, const T& c, const T& s) {
  const double *still = joint.still + 3 * i, *across = joint.across + 3 * i;
  const double* turned = joint.turned + 3 * i;
  return {mulAdd(turned[0], s, mulAdd(across[0], c, T(still[0]))),
          mulAdd(turned[1], s, mulAdd(across[1], c, T(still[1]))),
          mulAdd(turned[2], s, mulAdd(across[2], c, T(still[2])))};
}

template <typename T>
VWD_INLINE void turnLink(const JointShape& joint, const T& c, const T& s, const T* parent, T* R) {
  if (joint.parent == 0) {
    for (int i = 0; i < 3; ++i) putVector(R + 3 * i, turnedColumn(joint, i, c, s));
  } else if (joint.kind == JointKind::kTurnsPlainly) {
    const int x = 3 * joint.axis, y = joint.axis == 2 ? 0 : x + 3, z = 9 - x - y;
    const Vec3<T> along = vectorAt(parent + x), first = vectorAt(parent + y);
    const Vec3<T> second = vectorAt(parent + z);
    const T sine = joint.sign * s;
    putVector(R + x, along);
    putVector(R + y, addScaled(scaled(c, first), sine, second));
    putVector(R + z, addScaled(scaled(c, second), -sine, first));
  } else {
    for (int i = 0; i < 3; ++i) {
      const Vec3<T> column = turnedColumn(joint, i, c, s);
      putVector(R + 3 * i, turnedBy(parent, column.x, column.y, column.z));
    }
  }
}

template <int kWidth, typename T>
void placeLinks(const LinksView& view, const double* q_numbers, double* angle_numbers,
                double* link_numbers) {
  const T* const q = reinterpret_cast<const T*>(q_numbers);
  T* const angles = reinterpret_cast<T*>(angle_numbers);
  T* const links = reinterpret_cast<T*>(link_numbers);
  findAngles<kWidth>(view, q, angles);
  const T* const sines = angles + view.angle_count + kMostAngleLanes;
  for (int k = 0; k < view.joint_count; ++k) {
    const JointShape& joint = view.joints[k];
    const T* const parent = links + joint.parent * kLinkNumbers;
    T* const link = links + (k + 1) * kLinkNumbers;
    Vec3<T> o, z;
    if (joint.parent == 0) {
      o = constantVector<T>(joint.p_PoKo_P);
      z = constantVector<T>(joint.axis_P);
    } else {
      o = vectorAt(parent + kLinkO) + turnedBy(parent + kLinkR, joint.p_PoKo_P);
      z = joint.kind == JointKind::kTurnsPlainly
              ? scaled(joint.sign, vectorAt(parent + kLinkR + 3 * joint.axis))
              : turnedBy(parent + kLinkR, joint.axis_P);
    }
    putVector(link + kLinkZ, z);
    if (joint.angle >= 0) {
      turnLink(joint, angles[joint.angle], sines[joint.angle], parent + kLinkR, link + kLinkR);
    } else {
      for (int i = 0; i < 9; i += 3) {
        putVector(link + kLinkR + i, joint.parent == 0
                                         ? constantVector<T>(joint.still + i)
                                         : turnedBy(parent + kLinkR, joint.still + i));
      }
      if (joint.kind == JointKind::kSlides) {
        o = addScaled(o, mulAdd(joint.multiplier, q[joint.coordinate], T(joint.offset)), z);
      }
    }
    putVector(link + kLinkO, o);
  }
}

template <typename T>
void moveLinks(const LinksView& view, const double* qd_numbers, double* link_numbers) {
  const T* const qd = reinterpret_cast<const T*>(qd_numbers);
  T* const links = reinterpret_cast<T*>(link_numbers);
  for (int k = 0; k < view.joint_count; ++k) {
    const JointShape& joint = view.joints[k];
    const T* const parent = links + joint.parent * kLinkNumbers;
    T* const link = links + (k + 1) * kLinkNumbers;
    Vec3<T> rate = zeroVector<T>();
    if (joint.coordinate >= 0) {
      rate = scaled(joint.multiplier * qd[joint.coordinate], vectorAt(link + kLinkZ));
    }
    Vec3<T> v = zeroVector<T>(), w = v, a = v, alpha = v;
    if (joint.parent > 0) {
      const Vec3<T> r = vectorAt(link + kLinkO) - vectorAt(parent + kLinkO);
      w = vectorAt(parent + kLinkW);
      alpha = vectorAt(parent + kLinkAlpha);
      const Vec3<T> turned = cross(w, r);
      v = vectorAt(parent + kLinkV) + turned;                                  // (2.6)
      a = addCross(addCross(vectorAt(parent + kLinkA), alpha, r), w, turned);  // (2.7)
      if (joint.kind == JointKind::kSlides) {
        a = addCross(a, scaled(T(2.0), w), rate);  // (2.7)
      } else {
        alpha = addCross(alpha, w, rate);  // (2.7)
      }
    }
    putVector(link + kLinkV, joint.kind == JointKind::kSlides ? v + rate : v);  // (2.6)
    putVector(link + kLinkW, joint.kind == JointKind::kSlides ? w : w + rate);  // (2.5)
    putVector(link + kLinkA, a);
    putVector(link + kLinkAlpha, alpha);
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
