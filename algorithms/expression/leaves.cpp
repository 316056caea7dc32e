// SPDX-License-Identifier: MIT
#include "algorithms/expression/leaves.hpp"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include <cstddef>

namespace tribench {
namespace {

template <typename T>
void read_one_by_one(std::span<const Node> tape, const LeafLists<T>& lists) {
  std::uint32_t* operation = lists.operations;
  for (std::size_t i = 0; i < tape.size(); ++i) {
    const Node& node = tape[i];
    // Looked up, not asked: compilers make a branch of a conditional.
    const std::size_t is_column = node.op == Op::variable ? 1 : 0;
    const T* const either[2] = {lists.scalars + i, lists.columns[node.variable * is_column]};
    lists.values[i] = either[is_column];
    lists.scalars[i] = static_cast<T>(node.value);
    lists.kinds[i] = static_cast<std::uint8_t>(node.op);
    *operation = static_cast<std::uint32_t>(i);
    operation += node.op > Op::variable ? 1 : 0;
  }
  *operation = static_cast<std::uint32_t>(tape.size());
}

#if defined(__x86_64__)

// The layout that the vector form reads: value, then one word of length, variable and op.
static_assert(offsetof(Node, length) == 8 && offsetof(Node, variable) == 12 &&
              offsetof(Node, op) == 14 && sizeof(Op) == 1);
#define TRIBENCH_AVX512_POPCNT __attribute__((target("avx512f,avx512dq,avx512vl,avx512bw,popcnt")))

TRIBENCH_AVX512_POPCNT inline void store_scalars(double* out, __m512i bits) {
  _mm512_storeu_pd(out, _mm512_castsi512_pd(bits));
}
TRIBENCH_AVX512_POPCNT inline void store_scalars(float* out, __m512i bits) {
  _mm256_storeu_ps(out, _mm512_maskz_cvtpd_ps(0xff, _mm512_castsi512_pd(bits)));
}

// Eight nodes at a time; masked-out ones read as constants. The forms with a mask of ones are the
// plain instructions; GCC 12 warns about its own headers in the plain forms.
template <typename T>
TRIBENCH_AVX512_POPCNT void read_eight_by_eight(std::span<const Node> tape,
                                                const LeafLists<T>& lists) {
  const __m512i first_words = _mm512_set_epi64(14, 12, 10, 8, 6, 4, 2, 0);
  const __m512i second_words = _mm512_set_epi64(15, 13, 11, 9, 7, 5, 3, 1);
  const __m512i lane = _mm512_set_epi64(7, 6, 5, 4, 3, 2, 1, 0);
  const __m512i one = _mm512_set1_epi64(1);
  const __m512i scalar_offsets = _mm512_mullo_epi64(lane, _mm512_set1_epi64(sizeof(T)));
  std::uint32_t* operation = lists.operations;
  for (std::size_t i = 0; i < tape.size(); i += kLeavesAtOnce) {
    const std::size_t left = tape.size() - i;
    const unsigned words = left >= kLeavesAtOnce ? 0xffffU : (1U << (2 * left)) - 1U;
    const Node* const at = tape.data() + i;
    const __m512i low = _mm512_maskz_loadu_epi64(static_cast<__mmask8>(words), at);
    const __m512i high = _mm512_maskz_loadu_epi64(static_cast<__mmask8>(words >> 8), at + 4);
    const __m512i value = _mm512_permutex2var_epi64(low, first_words, high);
    const __m512i rest = _mm512_permutex2var_epi64(low, second_words, high);
    const __m512i op =
        _mm512_and_si512(_mm512_maskz_srli_epi64(0xff, rest, 48), _mm512_set1_epi64(0xff));
    const __m512i variable =
        _mm512_and_si512(_mm512_maskz_srli_epi64(0xff, rest, 32), _mm512_set1_epi64(0xffff));
    const __m512i scalars = _mm512_add_epi64(
        _mm512_set1_epi64(reinterpret_cast<std::int64_t>(lists.scalars + i)), scalar_offsets);
    const __m512i operand = _mm512_mask_i64gather_epi64(scalars, _mm512_cmpeq_epi64_mask(op, one),
                                                        variable, lists.columns, 8);
    store_scalars(lists.scalars + i, value);
    _mm512_storeu_si512(lists.values + i, operand);
    _mm512_mask_cvtepi64_storeu_epi8(lists.kinds + i, 0xff, op);
    const __mmask8 is_operation = _mm512_cmpgt_epu64_mask(op, one);
    const __m512i number = _mm512_add_epi64(_mm512_set1_epi64(static_cast<std::int64_t>(i)), lane);
    const __m512i packed = _mm512_maskz_compress_epi64(is_operation, number);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(operation),
                        _mm512_maskz_cvtepi64_epi32(0xff, packed));
    operation += __builtin_popcount(is_operation);
  }
  *operation = static_cast<std::uint32_t>(tape.size());
}

#endif

}  // namespace

template <typename T>
LeafReader<T> leaf_reader([[maybe_unused]] VectorLevel level) {
#if defined(__x86_64__)
  if (level == VectorLevel::avx512) return read_eight_by_eight<T>;
#endif
  return read_one_by_one<T>;
}

template LeafReader<double> leaf_reader<double>(VectorLevel level);
template LeafReader<float> leaf_reader<float>(VectorLevel level);

}  // namespace tribench
