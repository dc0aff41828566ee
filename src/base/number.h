#pragma once

#if defined(__FMA__)
#include <immintrin.h>
#endif

#include <cstddef>
#include <cstdint>
#include <cstring>

/// Inlined in every build: no copy compiled for one instruction set can serve another. Builds with
/// the address sanitizer are excepted, as its checks would take the compiler minutes and gigabytes.
#if defined(__has_feature)
#define VWD_HAS_ADDRESS_SANITIZER __has_feature(address_sanitizer)
#elif defined(__SANITIZE_ADDRESS__)
#define VWD_HAS_ADDRESS_SANITIZER 1
#else
#define VWD_HAS_ADDRESS_SANITIZER 0
#endif
#if VWD_HAS_ADDRESS_SANITIZER
#define VWD_INLINE inline
#define VWD_LAMBDA
#else
#define VWD_INLINE inline __attribute__((always_inline))
#define VWD_LAMBDA __attribute__((always_inline))
#endif
/// A condition that seldom holds: what it guards is laid aside, and the rest pays less for it.
#define VWD_SELDOM(condition) __builtin_expect(condition, 0)

namespace virtual_work_dynamics {
namespace {  // see tree/kernel/kernel.h

// Number types of the recursion need +, -, unary -, *, and the operations below. They are fused
// where the instruction set has them, and nowhere else: kernels are built with contraction off, so
// that builds with fused operations agree bit for bit.

/// Returns a b + c.
template <typename A, typename B, typename C>
VWD_INLINE C mulAdd(const A& a, const B& b, const C& c) {
  return a * b + c;
}

/// Returns c - a b.
template <typename A, typename B, typename C>
VWD_INLINE C subMul(const C& c, const A& a, const B& b) {
  return c - a * b;
}

/// Returns a b - c.
template <typename T>
VWD_INLINE T mulSub(const T& a, const T& b, const T& c) {
  return a * b - c;
}

/// Returns -(a b) - c.
template <typename T>
VWD_INLINE T minusMulSub(const T& a, const T& b, const T& c) {
  return -(a * b) - c;
}

#if defined(__FMA__)
VWD_INLINE double mulAdd(const double& a, const double& b, const double& c) {
  return __builtin_fma(a, b, c);
}
VWD_INLINE double subMul(const double& c, const double& a, const double& b) {
  return __builtin_fma(-a, b, c);
}
VWD_INLINE double mulSub(const double& a, const double& b, const double& c) {
  return __builtin_fma(a, b, -c);
}
VWD_INLINE double minusMulSub(const double& a, const double& b, const double& c) {
  return __builtin_fma(-a, b, -c);
}
VWD_INLINE float mulAdd(const float& a, const float& b, const float& c) {
  return __builtin_fmaf(a, b, c);
}
VWD_INLINE float subMul(const float& c, const float& a, const float& b) {
  return __builtin_fmaf(-a, b, c);
}
VWD_INLINE float mulSub(const float& a, const float& b, const float& c) {
  return __builtin_fmaf(a, b, -c);
}
VWD_INLINE float minusMulSub(const float& a, const float& b, const float& c) {
  return __builtin_fmaf(-a, b, -c);
}
#endif

template <typename R, int kWidth>
struct VectorOf {
  typedef R Type __attribute__((vector_size(kWidth * sizeof(R))));
};

/// The integer as wide as R.
template <typename R>
struct IndexOf;
template <>
struct IndexOf<double> {
  using Type = std::int64_t;
};
template <>
struct IndexOf<float> {
  using Type = std::int32_t;
};

/// kWidth samples side by side.
template <typename R, int kWidth>
struct Pack {
  using Vector = typename VectorOf<R, kWidth>::Type;
  Vector v;

  Pack() = default;
  VWD_INLINE Pack(Vector value) : v(value) {}
  VWD_INLINE explicit Pack(R value) : v(value - Vector{}) {}  // x - 0 is x, bit for bit
};

template <typename R, int kWidth>
VWD_INLINE Pack<R, kWidth> operator+(const Pack<R, kWidth>& a, const Pack<R, kWidth>& b) {
  return a.v + b.v;
}
template <typename R, int kWidth>
VWD_INLINE Pack<R, kWidth> operator-(const Pack<R, kWidth>& a, const Pack<R, kWidth>& b) {
  return a.v - b.v;
}
template <typename R, int kWidth>
VWD_INLINE Pack<R, kWidth> operator-(const Pack<R, kWidth>& a) {
  return -a.v;
}
template <typename R, int kWidth>
VWD_INLINE Pack<R, kWidth> operator*(const Pack<R, kWidth>& a, const Pack<R, kWidth>& b) {
  return a.v * b.v;
}
template <typename R, int kWidth>
VWD_INLINE Pack<R, kWidth> operator*(const R& a, const Pack<R, kWidth>& b) {
  return a * b.v;
}
template <typename R, int kWidth>
VWD_INLINE Pack<R, kWidth> operator*(const Pack<R, kWidth>& a, const R& b) {
  return a.v * b;
}

#if defined(__FMA__)
#define VWD_FUSED(Vector, prefix, suffix)                         \
  VWD_INLINE Vector fusedAdd(Vector a, Vector b, Vector c) {      \
    return prefix##_fmadd_##suffix(a, b, c);                      \
  }                                                               \
  VWD_INLINE Vector fusedSub(Vector a, Vector b, Vector c) {      \
    return prefix##_fmsub_##suffix(a, b, c);                      \
  }                                                               \
  VWD_INLINE Vector minusFusedAdd(Vector a, Vector b, Vector c) { \
    return prefix##_fnmadd_##suffix(a, b, c);                     \
  }                                                               \
  VWD_INLINE Vector minusFusedSub(Vector a, Vector b, Vector c) { \
    return prefix##_fnmsub_##suffix(a, b, c);                     \
  }
VWD_FUSED(__m128d, _mm, pd)
VWD_FUSED(__m128, _mm, ps)
VWD_FUSED(__m256d, _mm256, pd)
VWD_FUSED(__m256, _mm256, ps)
#if defined(__AVX512F__)
VWD_FUSED(__m512d, _mm512, pd)
VWD_FUSED(__m512, _mm512, ps)
#endif
#undef VWD_FUSED

template <typename R, int kWidth>
VWD_INLINE Pack<R, kWidth> mulSub(const Pack<R, kWidth>& a, const Pack<R, kWidth>& b,
                                  const Pack<R, kWidth>& c) {
  return Pack<R, kWidth>(fusedSub(a.v, b.v, c.v));
}
template <typename R, int kWidth>
VWD_INLINE Pack<R, kWidth> minusMulSub(const Pack<R, kWidth>& a, const Pack<R, kWidth>& b,
                                       const Pack<R, kWidth>& c) {
  return Pack<R, kWidth>(minusFusedSub(a.v, b.v, c.v));
}
template <typename R, int kWidth>
VWD_INLINE Pack<R, kWidth> mulAdd(const Pack<R, kWidth>& a, const Pack<R, kWidth>& b,
                                  const Pack<R, kWidth>& c) {
  return Pack<R, kWidth>(fusedAdd(a.v, b.v, c.v));
}
template <typename R, int kWidth>
VWD_INLINE Pack<R, kWidth> mulAdd(const R& a, const Pack<R, kWidth>& b, const Pack<R, kWidth>& c) {
  return mulAdd(Pack<R, kWidth>(a), b, c);
}
template <typename R, int kWidth>
VWD_INLINE Pack<R, kWidth> mulAdd(const Pack<R, kWidth>& a, const R& b, const Pack<R, kWidth>& c) {
  return mulAdd(a, Pack<R, kWidth>(b), c);
}
template <typename R, int kWidth>
VWD_INLINE Pack<R, kWidth> subMul(const Pack<R, kWidth>& c, const Pack<R, kWidth>& a,
                                  const Pack<R, kWidth>& b) {
  return Pack<R, kWidth>(minusFusedAdd(a.v, b.v, c.v));
}
template <typename R, int kWidth>
VWD_INLINE Pack<R, kWidth> subMul(const Pack<R, kWidth>& c, const R& a, const Pack<R, kWidth>& b) {
  return subMul(c, Pack<R, kWidth>(a), b);
}
template <typename R, int kWidth>
VWD_INLINE Pack<R, kWidth> subMul(const Pack<R, kWidth>& c, const Pack<R, kWidth>& a, const R& b) {
  return subMul(c, a, Pack<R, kWidth>(b));
}
#endif

/// Returns a b - product, where `product` is a b rounded: what rounding took away, exactly.
VWD_INLINE double productRest(const double& a, const double& b, const double& product) {
  return __builtin_fma(a, b, -product);
}
VWD_INLINE float productRest(const float& a, const float& b, const float& product) {
  return static_cast<float>(static_cast<double>(a) * static_cast<double>(b) -
                            static_cast<double>(product));
}
VWD_INLINE long double productRest(const long double& a, const long double& b,
                                   const long double& product) {
  return __builtin_fmal(a, b, -product);
}
template <typename R, int kWidth>
VWD_INLINE Pack<R, kWidth> productRest(const R& a, const Pack<R, kWidth>& b,
                                       const Pack<R, kWidth>& product) {
#if defined(__FMA__)
  return mulSub(Pack<R, kWidth>(a), b, product);
#else
  Pack<R, kWidth> rest;
  for (int i = 0; i < kWidth; ++i) rest.v[i] = productRest(a, b.v[i], product.v[i]);
  return rest;
#endif
}

/// Returns x, or 1 or -1 where x is beyond.
template <typename T>
VWD_INLINE T heldWithinOne(const T& x) {
  const T low = x < T(-1) ? T(-1) : x;
  return low > T(1) ? T(1) : low;
}
template <typename R, int kWidth>
VWD_INLINE Pack<R, kWidth> heldWithinOne(const Pack<R, kWidth>& x) {
  using T = Pack<R, kWidth>;
  const T one(R(1)), low(x.v < -one.v ? -one.v : x.v);
  return T(low.v > one.v ? one.v : low.v);
}

/// Reads and writes the neighbouring samples of a T.
template <typename T>
struct Neighbours {
  template <typename R>
  VWD_INLINE static T load(const R* from) {
    static_assert(sizeof(T) == sizeof(R), "T is one number");
    return T(*from);
  }
  template <typename R>
  VWD_INLINE static void store(R* to, const T& value) {
    std::memcpy(to, &value, sizeof(R));
  }
};

template <typename R, int kWidth>
struct Neighbours<Pack<R, kWidth>> {
  // Whole vectors at any address; memcpy would be moved in halves.
  typedef R Anywhere
      __attribute__((vector_size(kWidth * sizeof(R)), aligned(alignof(R)), may_alias));

  VWD_INLINE static Pack<R, kWidth> load(const R* from) {
    return Pack<R, kWidth>(*reinterpret_cast<const Anywhere*>(from));
  }
  VWD_INLINE static void store(R* to, const Pack<R, kWidth>& value) {
    *reinterpret_cast<Anywhere*>(to) = value.v;
  }
};

template <typename T, typename R>
VWD_INLINE T load(const R* from) {
  return Neighbours<T>::load(from);
}
template <typename T, typename R>
VWD_INLINE void store(R* to, const T& value) {
  Neighbours<T>::store(to, value);
}

}  // namespace
}  // namespace virtual_work_dynamics
