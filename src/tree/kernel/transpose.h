#pragma once

#include "base/number.h"

namespace virtual_work_dynamics {
namespace {  // see kernel.h

// Transposition between rows of samples and the columns that packs are made of.

/// Transposes in place: entry j of rows[i] becomes entry i of rows[j].
template <typename Vector, std::size_t kWidth>
VWD_INLINE void transpose(Vector (&rows)[kWidth]) {
  for (std::size_t i = 0; i < kWidth; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto upper = rows[j][i];
      rows[j][i] = rows[i][j];
      rows[i][j] = upper;
    }
  }
}

#if defined(__AVX2__)
VWD_INLINE void transpose(VectorOf<double, 4>::Type (&rows)[4]) {
  const __m256d even_01 = _mm256_unpacklo_pd(rows[0], rows[1]);
  const __m256d odd_01 = _mm256_unpackhi_pd(rows[0], rows[1]);
  const __m256d even_23 = _mm256_unpacklo_pd(rows[2], rows[3]);
  const __m256d odd_23 = _mm256_unpackhi_pd(rows[2], rows[3]);
  rows[0] = _mm256_permute2f128_pd(even_01, even_23, 0x20);
  rows[1] = _mm256_permute2f128_pd(odd_01, odd_23, 0x20);
  rows[2] = _mm256_permute2f128_pd(even_01, even_23, 0x31);
  rows[3] = _mm256_permute2f128_pd(odd_01, odd_23, 0x31);
}
#endif

#if defined(__AVX512F__)
/// Gathers columns c, c + 2, c + 4 and c + 6 of a tile from its rows, which come in the pairs 0-1,
/// 2-3, 4-5 and 6-7.
VWD_INLINE void gatherPairs(__m512d rows_01, __m512d rows_23, __m512d rows_45, __m512d rows_67,
                            VectorOf<double, 8>::Type* columns) {
  const __m512d near_0123 = _mm512_shuffle_f64x2(rows_01, rows_23, 0x88);
  const __m512d far_0123 = _mm512_shuffle_f64x2(rows_01, rows_23, 0xdd);
  const __m512d near_4567 = _mm512_shuffle_f64x2(rows_45, rows_67, 0x88);
  const __m512d far_4567 = _mm512_shuffle_f64x2(rows_45, rows_67, 0xdd);
  columns[0] = _mm512_shuffle_f64x2(near_0123, near_4567, 0x88);
  columns[4] = _mm512_shuffle_f64x2(near_0123, near_4567, 0xdd);
  columns[2] = _mm512_shuffle_f64x2(far_0123, far_4567, 0x88);
  columns[6] = _mm512_shuffle_f64x2(far_0123, far_4567, 0xdd);
}

VWD_INLINE void transpose(VectorOf<double, 8>::Type (&rows)[8]) {
  __m512d even[4], odd[4];
  for (int i = 0; i < 4; ++i) {
    even[i] = _mm512_unpacklo_pd(rows[2 * i], rows[2 * i + 1]);
    odd[i] = _mm512_unpackhi_pd(rows[2 * i], rows[2 * i + 1]);
  }
  gatherPairs(even[0], even[1], even[2], even[3], rows);
  gatherPairs(odd[0], odd[1], odd[2], odd[3], rows + 1);
}
#endif

/// Reads the first `count` entries of a row into a vector, or writes them back.
template <typename Vector, typename R>
VWD_INLINE void loadPart(const R* from, std::size_t count, Vector& to) {
  to = Vector{};
  for (std::size_t i = 0; i < count; ++i) to[i] = from[i];
}
template <typename Vector, typename R>
VWD_INLINE void storePart(R* to, std::size_t count, const Vector& from) {
  for (std::size_t i = 0; i < count; ++i) to[i] = from[i];
}
#if defined(__AVX512F__)
VWD_INLINE void loadPart(const double* from, std::size_t count, VectorOf<double, 8>::Type& to) {
  to = _mm512_maskz_loadu_pd(static_cast<__mmask8>((1u << count) - 1), from);
}
VWD_INLINE void storePart(double* to, std::size_t count, const VectorOf<double, 8>::Type& from) {
  _mm512_mask_storeu_pd(to, static_cast<__mmask8>((1u << count) - 1), from);
}
#endif

/// Takes column `first` and the kWidth - 1 behind it from kWidth rows.
template <typename R, int kWidth>
VWD_INLINE void blockToColumns(const R* rows, std::size_t columns, std::size_t first, R* tile) {
  typename VectorOf<R, kWidth>::Type block[kWidth];
  for (std::size_t i = 0; i < kWidth; ++i) {
    block[i] = load<Pack<R, kWidth>>(rows + i * columns + first).v;
  }
  transpose(block);
  for (std::size_t i = 0; i < kWidth; ++i) {
    store(tile + (first + i) * kWidth, Pack<R, kWidth>(block[i]));
  }
}

template <typename R, int kWidth>
VWD_INLINE void blockToRows(const R* tile, std::size_t columns, std::size_t first, R* rows) {
  typename VectorOf<R, kWidth>::Type block[kWidth];
  for (std::size_t i = 0; i < kWidth; ++i) {
    block[i] = load<Pack<R, kWidth>>(tile + (first + i) * kWidth).v;
  }
  transpose(block);
  for (std::size_t i = 0; i < kWidth; ++i) {
    store(rows + i * columns + first, Pack<R, kWidth>(block[i]));
  }
}

/// Turns kWidth rows of `columns` numbers into `columns` columns of kWidth numbers. The last block
/// of columns overlaps the one before where it must; the tile has room for kWidth columns at least.
template <typename R, int kWidth>
void toColumns(const R* rows, std::size_t columns, R* tile) {
  if (columns >= kWidth) {
    for (std::size_t c = 0; c + kWidth < columns; c += kWidth) {
      blockToColumns<R, kWidth>(rows, columns, c, tile);
    }
    return blockToColumns<R, kWidth>(rows, columns, columns - kWidth, tile);
  }
  typename VectorOf<R, kWidth>::Type block[kWidth];
  for (std::size_t i = 0; i < kWidth; ++i) {
    if (i * columns + kWidth <= kWidth * columns) {  // what follows the row may be read, too
      block[i] = load<Pack<R, kWidth>>(rows + i * columns).v;
    } else {
      loadPart(rows + i * columns, columns, block[i]);
    }
  }
  transpose(block);
  for (std::size_t c = 0; c < kWidth; ++c) store(tile + c * kWidth, Pack<R, kWidth>(block[c]));
}

template <typename R, int kWidth>
void toRows(const R* tile, std::size_t columns, R* rows) {
  if (columns >= kWidth) {
    for (std::size_t c = 0; c + kWidth < columns; c += kWidth) {
      blockToRows<R, kWidth>(tile, columns, c, rows);
    }
    return blockToRows<R, kWidth>(tile, columns, columns - kWidth, rows);
  }
  typename VectorOf<R, kWidth>::Type block[kWidth];
  for (std::size_t c = 0; c < kWidth; ++c) block[c] = load<Pack<R, kWidth>>(tile + c * kWidth).v;
  transpose(block);
  for (std::size_t i = 0; i < kWidth; ++i) {
    if (i * columns + kWidth <= kWidth * columns) {  // the next row is written after this one
      store(rows + i * columns, Pack<R, kWidth>(block[i]));
    } else {
      storePart(rows + i * columns, columns, block[i]);
    }
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
