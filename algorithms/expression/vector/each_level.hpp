// SPDX-License-Identifier: MIT
//
// TRIBENCH_EACH_LEVEL before a function: one copy of it for each instruction set, the loader picks.
// For loops that the compiler turns into vectors by itself; nothing here is fused or reordered
// (-ffp-contract=off), so every copy gives the same bits. Functions that it calls are not copied.
//
// TRIBENCH_AVX512 before a function: for processors with 64-byte vectors alone, where
// TRIBENCH_HAS_AVX512 is true; who calls it asks vector_level() first.
//
// The sanitizers' start-up cannot run such a choice, and other compilers and machines get the plain
// copy.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)
#define TRIBENCH_EACH_LEVEL \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#define TRIBENCH_AVX512 \
  __attribute__((target("avx2,fma,avx512f,avx512dq,avx512vl,avx512bw,prefer-vector-width=512")))
#define TRIBENCH_HAS_AVX512 true
#else
#define TRIBENCH_EACH_LEVEL
#define TRIBENCH_AVX512
#define TRIBENCH_HAS_AVX512 false
#endif
