#pragma once

namespace virtual_work_dynamics {

// Text of C at the beginning of every generated source: packs of numbers, fused operations, sines
// and cosines. $n stands for the name of the function, $N for it in capitals. Sines and cosines are
// those of tree/kernel/sine_cosine.h, operation by operation.
constexpr char kPrelude[] = R"(
#include <math.h>
#if defined(__GNUC__) && (defined(__AVX512F__) || (defined(__AVX__) && defined(__FMA__)))
#include <immintrin.h>
#endif
/* Products and sums are rounded one by one where the text does not fuse them. */
#if defined(__FAST_MATH__)
#error "with -ffast-math the results would not be those of virtual_work_dynamics"
#endif
#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF
#elif defined(__GNUC__)
#pragma GCC push_options
#pragma GCC optimize("-ffp-contract=off", "-fno-tree-slp-vectorize")
#endif

/* a * b + c with one rounding where the machine has it, as the AVX2 and AVX-512 builds of the package
   compute; with two elsewhere, as its baseline build does. 1 or 0 decides it otherwise. */
#ifndef $N_FUSED
#if defined(__FMA__) || defined(__FP_FAST_FMA) || defined(FP_FAST_FMA)
#define $N_FUSED 1
#else
#define $N_FUSED 0
#endif
#endif
#if defined(__GNUC__)
#define $N_EXACT_FMA(a, b, c) __builtin_fma(a, b, c)
#define $N_RESTRICT __restrict__
#define $N_APART __attribute__((noinline))
#define $N_WITHIN static inline __attribute__((always_inline, unused))
#else
#define $N_EXACT_FMA(a, b, c) fma(a, b, c)
#define $N_RESTRICT
#define $N_APART
#define $N_WITHIN static
#endif
#if $N_FUSED
#define $N_FMA(a, b, c) $N_EXACT_FMA(a, b, c)
#else
#define $N_FMA(a, b, c) ((a) * (b) + (c))
#endif

/* Numbers side by side: in a pack those of some samples; the few sines of one sample are quicker in
   vectors that are not the widest, among which other operations would have to wait. */
#if !defined(__GNUC__)
#define $N_PACK_WIDTH 1
#define $N_FEW_WIDTH 1
#elif defined(__AVX512F__)
#define $N_PACK_WIDTH 8
#define $N_FEW_WIDTH 4
#elif defined(__AVX__)
#define $N_PACK_WIDTH 4
#define $N_FEW_WIDTH 4
#else
#define $N_PACK_WIDTH 2
#define $N_FEW_WIDTH 2
#endif

/* Without AVX-512VL clang moves single numbers in the widest vectors: then one sample is computed
   without AVX-512. */
#if defined(__clang__) && defined(__AVX512F__) && !defined(__AVX512VL__)
#define $N_NARROW 1
#else
#define $N_NARROW 0
#endif
)";

// Packs, of two kinds: $p stands for their name, $P for it in capitals.
constexpr char kPacks[] = R"(
#if $N_$P_WIDTH > 1
typedef double $n_$p __attribute__((vector_size(8 * $N_$P_WIDTH)));
typedef double $n_$p_at __attribute__((vector_size(8 * $N_$P_WIDTH), aligned(8), may_alias));
typedef unsigned long long $n_$p_bits __attribute__((vector_size(8 * $N_$P_WIDTH)));
$N_WITHIN $n_$p $n_$p_all(double a) {
  const $n_$p zero = {0.0};
  return a - zero;
}
$N_WITHIN void $n_$p_store(double *to, $n_$p a) { *($n_$p_at *)to = a; }
#if $N_FUSED && defined(__AVX512F__) && $N_$P_WIDTH == 8
$N_WITHIN $n_$p $n_$p_fma($n_$p a, $n_$p b, $n_$p c) { return _mm512_fmadd_pd(a, b, c); }
$N_WITHIN $n_$p $n_$p_fnma($n_$p a, $n_$p b, $n_$p c) { return _mm512_fnmadd_pd(a, b, c); }
$N_WITHIN $n_$p $n_$p_fms($n_$p a, $n_$p b, $n_$p c) { return _mm512_fmsub_pd(a, b, c); }
$N_WITHIN $n_$p $n_$p_fnms($n_$p a, $n_$p b, $n_$p c) { return _mm512_fnmsub_pd(a, b, c); }
#elif $N_FUSED && defined(__FMA__) && $N_$P_WIDTH == 4 && !$N_NARROW
$N_WITHIN $n_$p $n_$p_fma($n_$p a, $n_$p b, $n_$p c) { return _mm256_fmadd_pd(a, b, c); }
$N_WITHIN $n_$p $n_$p_fnma($n_$p a, $n_$p b, $n_$p c) { return _mm256_fnmadd_pd(a, b, c); }
$N_WITHIN $n_$p $n_$p_fms($n_$p a, $n_$p b, $n_$p c) { return _mm256_fmsub_pd(a, b, c); }
$N_WITHIN $n_$p $n_$p_fnms($n_$p a, $n_$p b, $n_$p c) { return _mm256_fnmsub_pd(a, b, c); }
#else
$N_WITHIN $n_$p $n_$p_fma($n_$p a, $n_$p b, $n_$p c) {
#if $N_FUSED
  int i;
  for (i = 0; i < $N_$P_WIDTH; ++i) a[i] = __builtin_fma(a[i], b[i], c[i]);
  return a;
#else
  return a * b + c;
#endif
}
$N_WITHIN $n_$p $n_$p_fnma($n_$p a, $n_$p b, $n_$p c) { return $n_$p_fma(-a, b, c); }
$N_WITHIN $n_$p $n_$p_fms($n_$p a, $n_$p b, $n_$p c) { return $n_$p_fma(a, b, -c); }
$N_WITHIN $n_$p $n_$p_fnms($n_$p a, $n_$p b, $n_$p c) { return $n_$p_fma(-a, b, -c); }
#endif
#endif
)";

// Of robots with joints that turn: constants, then functions for each kind of packs, then those for
// one sample.
constexpr char kSineConstants[] = R"(
/* Sines and cosines of angles up to $N_RANGE rad; returns whether all are. With -D$N_LIBM those of the
   C library serve for all angles. */
#define $N_RANGE 1.0e6
#if defined($N_LIBM) || $N_PACK_WIDTH == 1
#define $N_BY_LIBRARY 1
#else
#define $N_BY_LIBRARY 0
#endif
)";

constexpr char kPackSines[] = R"(
#if $N_$P_WIDTH > 1
$N_WITHIN int $n_$p_sine_cosine($n_$p angle, $n_$p *sine, $n_$p *cosine) {
  /* The angle less k quarter turns, in three steps; then the polynomials of fdlibm. */
  const $n_$p round = $n_$p_all(6755399441055744.0), one = $n_$p_all(1.0);
  const $n_$p shifted = $n_$p_fma(angle, $n_$p_all(6.36619772367581382433e-01), round);
  const $n_$p k = shifted - round;
  const $n_$p r1 = $n_$p_fnma(k, $n_$p_all(1.57079632673412561417e+00), angle);
  const $n_$p r2 = $n_$p_fnma(k, $n_$p_all(6.07710050630396597660e-11), r1);
  const $n_$p r = $n_$p_fnma(k, $n_$p_all(2.02226624879595063154e-21), r2);
  const $n_$p z = r * r, half = 0.5 * z, rounded = one - half;
  $n_$p s, c;
  $n_$p_bits quadrant, odd, inside;
  int i, every = 1;
  s = $n_$p_fma(z, $n_$p_all(1.58969099521155010221e-10), $n_$p_all(-2.50507602534068634195e-08));
  s = $n_$p_fma(z, s, $n_$p_all(2.75573137070700676789e-06));
  s = $n_$p_fma(z, s, $n_$p_all(-1.98412698298579493134e-04));
  s = $n_$p_fma(z, s, $n_$p_all(8.33333333332248946124e-03));
  s = $n_$p_fma(z, s, $n_$p_all(-1.66666666666666324348e-01));
  s = $n_$p_fma(z * r, s, r);
  c = $n_$p_fma(z, $n_$p_all(-1.13596475577881948265e-11), $n_$p_all(2.08757232129817482790e-09));
  c = $n_$p_fma(z, c, $n_$p_all(-2.75573143513906633035e-07));
  c = $n_$p_fma(z, c, $n_$p_all(2.48015872894767294178e-05));
  c = $n_$p_fma(z, c, $n_$p_all(-1.38888888888741095749e-03));
  c = $n_$p_fma(z, c, $n_$p_all(4.16666666666666019037e-02));
  c = rounded + $n_$p_fma(z * z, c, (one - rounded) - half);
  quadrant = ($n_$p_bits)shifted; /* its last bits are those of k: odd quarters swap, signs go round */
  odd = -(quadrant & 1);
  *sine = ($n_$p)(((($n_$p_bits)c & odd) | (($n_$p_bits)s & ~odd)) ^ ((quadrant & 2) << 62));
  *cosine = ($n_$p)(((($n_$p_bits)s & odd) | (($n_$p_bits)c & ~odd)) ^ (((quadrant + 1) & 2) << 62));
  inside = ($n_$p_bits)((angle <= $n_$p_all($N_RANGE)) & (angle >= $n_$p_all(-$N_RANGE)));
  for (i = 0; i < $N_$P_WIDTH; ++i) every &= (int)inside[i];
  return every;
}
#endif
)";

constexpr char kSines[] = R"(
/* Sines and cosines of the angles that are out of range, or of all. */
$N_APART static void $n_library_sines(int count, const double *angle, double *rest, double *sine,
                                      double *cosine) {
  int i;
  for (i = 0; i < count; ++i) {
    double turned = angle[i];
    if (!$N_BY_LIBRARY && turned <= $N_RANGE && turned >= -$N_RANGE) continue;
    if (rest) {
      turned = angle[i] + rest[i];
      rest[i] = rest[i] - (turned - angle[i]);
    }
    sine[i] = sin(turned);
    cosine[i] = cos(turned);
  }
}

/* Of eight angles: returns whether all were in range. They are not read from memory, where vectors would
   have to wait for numbers that were just written one by one. */
#if $N_BY_LIBRARY
#define $n_sines(a, b, c, d, e, f, g, h, sine, cosine) 0
#else
$N_WITHIN int $n_sines(double a, double b, double c, double d, double e, double f, double g, double h,
                       double *sine, double *cosine) {
#if $N_FEW_WIDTH == 8
  const $n_few angle[1] = {{a, b, c, d, e, f, g, h}};
#elif $N_FEW_WIDTH == 4
  const $n_few angle[2] = {{a, b, c, d}, {e, f, g, h}};
#else
  const $n_few angle[4] = {{a, b}, {c, d}, {e, f}, {g, h}};
#endif
  int i, every = 1;
  for (i = 0; i < 8 / $N_FEW_WIDTH; ++i) {
    $n_few sines, cosines;
    every &= $n_few_sine_cosine(angle[i], &sines, &cosines);
    $n_few_store(sine + i * $N_FEW_WIDTH, sines);
    $n_few_store(cosine + i * $N_FEW_WIDTH, cosines);
  }
  return every;
}
#endif
)";

// Of loops: roots, and what packs choose number by number. First what all need, then packs.
constexpr char kRoots[] = R"(
#if defined(__GNUC__)
#define $N_ROOT(a) __builtin_sqrt(a)
#else
#define $N_ROOT(a) sqrt(a)
#endif
)";
constexpr char kPackChoices[] = R"(
#if $N_PACK_WIDTH > 1
$N_WITHIN $n_pack $n_pack_root($n_pack a) {
#if defined(__AVX512F__)
  return _mm512_sqrt_pd(a);
#elif defined(__AVX__) && defined(__FMA__)
  return _mm256_sqrt_pd(a);
#else
  int i;
  for (i = 0; i < $N_PACK_WIDTH; ++i) a[i] = __builtin_sqrt(a[i]);
  return a;
#endif
}
/* Of each number the third where the first is less than the second, or at most that; else the fourth. */
$N_WITHIN $n_pack $n_pack_less($n_pack a, $n_pack b, $n_pack then, $n_pack otherwise) {
  const $n_pack_bits less = ($n_pack_bits)(a < b);
  return ($n_pack)((($n_pack_bits)then & less) | (($n_pack_bits)otherwise & ~less));
}
$N_WITHIN $n_pack $n_pack_at_most($n_pack a, $n_pack b, $n_pack then, $n_pack otherwise) {
  const $n_pack_bits at_most = ($n_pack_bits)(a <= b);
  return ($n_pack)((($n_pack_bits)then & at_most) | (($n_pack_bits)otherwise & ~at_most));
}
#endif
)";

// Around what computes one sample.
constexpr char kOneSample[] = R"(
#if $N_NARROW
#pragma clang attribute push(__attribute__((target("no-avx512f"))), apply_to = function)
#elif defined(__GNUC__) && !defined(__clang__)
#pragma GCC push_options
#pragma GCC optimize("-fschedule-insns", "-fsched-pressure")
#endif
)";
constexpr char kOneSampleEnd[] = R"(
#if $N_NARROW
#pragma clang attribute pop
#elif defined(__GNUC__) && !defined(__clang__)
#pragma GCC pop_options
#endif
)";

// At the end of every generated source.
constexpr char kEnding[] = R"(
#if defined(__clang__)
#pragma STDC FP_CONTRACT DEFAULT
#elif defined(__GNUC__)
#pragma GCC pop_options
#endif
)";

}  // namespace virtual_work_dynamics
