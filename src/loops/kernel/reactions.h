#pragma once

#include "base/number_choices.h"
#include "loops/kernel/links.h"

namespace virtual_work_dynamics {
namespace {  // see loop_kernel.h

/// A wrench in root axes.
template <typename T>
struct RootWrench {
  Vec3<T> force, moment;
};

template <typename T>
VWD_INLINE RootWrench<T> wrenchAt(const T* from) {
  return {vectorAt(from), vectorAt(from + 3)};
}
template <typename T>
VWD_INLINE void putWrench(T* to, const RootWrench<T>& wrench) {
  putVector(to, wrench.force);
  putVector(to + 3, wrench.moment);
}

template <typename T>
VWD_INLINE Vec3<T> opposite(const Vec3<T>& v) {
  return {-v.x, -v.y, -v.z};
}
/// Returns v less its part along a unit vector.
template <typename T>
VWD_INLINE Vec3<T> without(const Vec3<T>& v, const Vec3<T>& axis) {
  return addScaled(v, -dot(axis, v), axis);
}

/// Takes away what is not reported of a wrench about the child frame's origin.
template <typename T>
VWD_INLINE RootWrench<T> reportedPart(const ReactionShape& shape, const T* links, const T* frames,
                                      RootWrench<T> wrench) {
  if (shape.left_out == LeftOut::kNothing) return wrench;
  const Vec3<T> axis = vectorAt(shape.closure >= 0 ? frames + shape.closure * kFrameNumbers +
                                                         kFrameP + 6  // its free axis
                                                   : links + shape.link * kLinkNumbers + kLinkZ);
  switch (shape.left_out) {
    case LeftOut::kNothing:
      break;
    case LeftOut::kForceAlong:
      wrench.force = without(wrench.force, axis);
      break;
    case LeftOut::kMomentAbout:
      wrench.moment = without(wrench.moment, axis);
      break;
    case LeftOut::kPlanar:
      wrench.force = scaled(dot(axis, wrench.force), axis);
      wrench.moment = without(wrench.moment, axis);
      break;
    case LeftOut::kCylindrical:
      wrench = {without(wrench.force, axis), without(wrench.moment, axis)};
      break;
    case LeftOut::kScrew:
      wrench.moment =
          addScaled(without(wrench.moment, axis), -shape.pitch * dot(axis, wrench.force), axis);
      break;
    case LeftOut::kSpherical:
      wrench.moment = zeroVector<T>();
      break;
    case LeftOut::kFloating:
      wrench = {zeroVector<T>(), zeroVector<T>()};
      break;
    case LeftOut::kUniversal: {
      const Vec3<T> normal =
          cross(vectorAt(links + shape.first_link * kLinkNumbers + kLinkZ), axis);
      const T square = dot(normal, normal);
      const T share = wherePositive(square, T(1.0) / square, T(1.0));
      wrench.moment = scaled(share * dot(normal, wrench.moment), normal);
      break;
    }
  }
  return wrench;
}

/// Turns a wrench about the child frame's origin into the one that is reported.
template <typename T>
VWD_INLINE RootWrench<T> reportedWrench(const ReactionShape& shape, bool child_axes, const T* links,
                                        const T* frames, RootWrench<T> wrench) {
  wrench = reportedPart(shape, links, frames, wrench);
  const T* const frame = frames + shape.closure * kFrameNumbers;
  const T* const link = links + shape.link * kLinkNumbers;
  if (shape.point_link >= 0) {
    const T* const of_point = links + shape.point_link * kLinkNumbers;
    const Vec3<T> point = vectorAt(of_point + kLinkO) + turnedBy(of_point + kLinkR, shape.p_LoPo_L);
    const Vec3<T> origin = vectorAt(shape.closure >= 0 ? frame + kFrameCo : link + kLinkO);
    wrench.moment = addCross(wrench.moment, origin - point, wrench.force);
  }
  if (!child_axes) return wrench;
  const T* const R = shape.closure >= 0 ? frame + kFrameC : link + kLinkR;
  const Vec3<T> x = vectorAt(R), y = vectorAt(R + 3), z = vectorAt(R + 6);
  return {{dot(x, wrench.force), dot(y, wrench.force), dot(z, wrench.force)},
          {dot(x, wrench.moment), dot(y, wrench.moment), dot(z, wrench.moment)}};
}

/// Reactions of the open tree, and on the joints of loops what closures add: (3.8) is linear in the
/// loads.
template <typename T>
void findReactions(const ReactionsView& view, const ReactionNumbers& numbers) {
  const T* const links = reinterpret_cast<const T*>(numbers.links);
  const T* const frames = reinterpret_cast<const T*>(numbers.frames);
  const T* const closures = reinterpret_cast<const T*>(numbers.closures);
  const double* tree = numbers.tree;
  T* value = reinterpret_cast<T*>(numbers.values);
  for (int i = 0; i < view.count; ++i, value += kWrenchNumbers) {
    const ReactionShape& shape = view.shapes[i];
    if (shape.closure >= 0) {
      const RootWrench<T> own = wrenchAt(closures + shape.closure * kWrenchNumbers);
      putWrench(value, reportedWrench(shape, view.child_axes, links, frames, own));
      continue;
    }
    for (int j = 0; j < kWrenchNumbers; ++j, tree += numbers.tree_stride) {
      value[j] = load<T>(tree);
    }
    if (shape.passages_begin == shape.passages_end) continue;
    RootWrench<T> sum{zeroVector<T>(), zeroVector<T>()};
    const Vec3<T> origin = vectorAt(links + shape.link * kLinkNumbers + kLinkO);
    for (int p = shape.passages_begin; p < shape.passages_end; ++p) {
      const PassageShape& passage = view.passages[p];
      const RootWrench<T> wrench = wrenchAt(closures + passage.closure * kWrenchNumbers);
      const Vec3<T> at = vectorAt(frames + passage.closure * kFrameNumbers + kFrameCo);
      const Vec3<T> moment = addCross(wrench.moment, at - origin, wrench.force);
      sum.force = addScaled(sum.force, -passage.sign, wrench.force);
      sum.moment = addScaled(sum.moment, -passage.sign, moment);
    }
    const RootWrench<T> added = reportedWrench(shape, view.child_axes, links, frames, sum);
    const RootWrench<T> of_tree = wrenchAt(value);
    putWrench(value, RootWrench<T>{of_tree.force + added.force, of_tree.moment + added.moment});
  }
}

/// The wrench of each closure on its child about the child frame's origin, and its opposite on the
/// parent about the parent frame's.
template <typename T>
void findClosureLoads(int count, const double* frame_numbers, const double* wrench_numbers,
                      double* to) {
  const T* frame = reinterpret_cast<const T*>(frame_numbers);
  const T* wrenches = reinterpret_cast<const T*>(wrench_numbers);
  T* loads = reinterpret_cast<T*>(to);
  for (int c = 0; c < count; ++c) {
    const RootWrench<T> wrench = wrenchAt(wrenches);
    const Vec3<T> lever = vectorAt(frame + kFrameCo) - vectorAt(frame + kFramePo);
    const Vec3<T> moment = addCross(wrench.moment, lever, wrench.force);
    putWrench(loads, wrench);
    putWrench(loads + kWrenchNumbers, RootWrench<T>{opposite(wrench.force), opposite(moment)});
    frame += kFrameNumbers;
    wrenches += kWrenchNumbers;
    loads += 2 * kWrenchNumbers;
  }
}

inline void leaveOut(const ReactionShape& shape, const double* links, const double* frames,
                     double* wrench) {
  putWrench(wrench, reportedPart(shape, links, frames, wrenchAt<double>(wrench)));
}

inline void reportWrench(const ReactionShape& shape, bool child_axes, const double* links,
                         const double* frames, double* wrench) {
  putWrench(wrench, reportedWrench(shape, child_axes, links, frames, wrenchAt<double>(wrench)));
}

}  // namespace
}  // namespace virtual_work_dynamics
