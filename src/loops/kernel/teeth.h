#pragma once

#include "base/number_choices.h"
#include "loops/kernel/frames.h"

namespace virtual_work_dynamics {
namespace {  // see loop_kernel.h

// Teeth that mesh; see GearConditions.

/// See MeshNumber.
template <typename T>
struct Mesh {
  Vec3<T> lever, along, axis, away;
};

// With the signed distance d of the centres, u = (Co - Po) / d points from the parent's centre to
// the pitch point where its teeth are outside, and the other way where they are inside. Radii are
// those of the centres as they are, in the ratio of the radii that are given.
template <typename T>
VWD_INLINE Mesh<T> meshOf(const TeethShape& teeth, const T* frames) {
  Mesh<T> mesh;
  mesh.axis = vectorAt(frames + kFrameP + 6);
  const Vec3<T> r = vectorAt(frames + kFrameCo) - vectorAt(frames + kFramePo);
  Vec3<T> across = addScaled(r, -dot(r, mesh.axis), mesh.axis);
  const double distance = teeth.parent_radius + (teeth.is_rack ? 0 : teeth.child_radius);
  if (teeth.is_rack) {
    const Vec3<T> slide = vectorAt(frames + kFrameC);
    mesh.lever = scaled(-dot(r, slide), slide);
    across = across + mesh.lever;
  } else {
    mesh.lever = scaled(-teeth.child_radius / distance, across);
  }
  const T share = T(distance < 0 ? -1.0 : 1.0) / squareRoot(dot(across, across));
  mesh.away = scaled(share, across);
  mesh.along = cross(mesh.axis, mesh.away);
  return mesh;
}

/// The force of a tangential force of one. @param radial its share away from the parent
template <typename T>
VWD_INLINE Vec3<T> toothForce(const TeethShape& teeth, const Mesh<T>& mesh, double radial) {
  return addScaled(addScaled(mesh.along, teeth.axial, mesh.axis), radial, mesh.away);
}

template <typename T>
VWD_INLINE void placeTeeth(const ClosureShape& shape, const T* links, const ClosureNumbers& to) {
  const TeethShape& teeth = *shape.teeth;
  T* const frames = reinterpret_cast<T*>(to.frames);
  T* const wrench = reinterpret_cast<T*>(to.wrenches);
  T* const A = reinterpret_cast<T*>(to.A);
  placeFrame(shape.parent, links, frames + kFrameP, frames + kFramePo);
  placeFrame(shape.child, links, frames + kFrameC, frames + kFrameCo);
  const Mesh<T> mesh = meshOf(teeth, frames);
  const Vec3<T> force = toothForce(teeth, mesh, teeth.radial);
  putVector(wrench, force);
  putVector(wrench + 3, cross(mesh.lever, force));
  for (int k = 0; k < teeth.terms; ++k) {
    A[static_cast<std::size_t>(teeth.coordinates[k]) * to.A_stride] = T(teeth.factors[k]);  // (3.2)
  }
}

// Roundings of a sum, of its terms.
constexpr double kTurnRounding = 4 * __DBL_EPSILON__;

template <typename T>
void sumTurns(const TeethShape& teeth, const double* q_numbers, double* phi, double* rounding) {
  const T* const q = reinterpret_cast<const T*>(q_numbers);
  T sum = T(0.0), size = T(0.0);
  for (int k = 0; k < teeth.terms; ++k) {
    const T part = teeth.factors[k] * q[teeth.coordinates[k]];
    sum = sum + part;
    size = size + absolute(part);
  }
  *reinterpret_cast<T*>(phi) = sum;  // (3.3)
  *reinterpret_cast<T*>(rounding) = kTurnRounding * size;
}

template <typename T>
void takeFlank(const ClosureShape& shape, const double* units, const double* x_numbers,
               const double* bearing_numbers, const double* frame_numbers, double* to) {
  const T bearing = *reinterpret_cast<const T*>(bearing_numbers);
  if (lanesAbove(T(0.0), bearing) == 0) return;
  const TeethShape& teeth = *shape.teeth;
  const Mesh<T> mesh = meshOf(teeth, reinterpret_cast<const T*>(frame_numbers));
  const T multiplier = units[0] * *reinterpret_cast<const T*>(x_numbers);
  const Vec3<T> force = scaled(multiplier, toothForce(teeth, mesh, -teeth.radial));
  const Vec3<T> moment = cross(mesh.lever, force);
  T* const sum = reinterpret_cast<T*>(to);
  const T reversed[] = {force.x, force.y, force.z, moment.x, moment.y, moment.z};
  for (int j = 0; j < kWrenchNumbers; ++j) sum[j] = wherePositive(-bearing, reversed[j], sum[j]);
}

inline void findMesh(const ClosureShape& shape, const double* frames, double* to) {
  const Mesh<double> mesh = meshOf(*shape.teeth, frames);
  putVector(to + kMeshLever, mesh.lever);
  putVector(to + kMeshAlong, mesh.along);
  putVector(to + kMeshAxis, mesh.axis);
  putVector(to + kMeshAway, mesh.away);
}

}  // namespace
}  // namespace virtual_work_dynamics
