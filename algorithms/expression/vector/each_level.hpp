// SPDX-License-Identifier: MIT
//
// TRIBENCH_EACH_LEVEL before a function: one copy of it for each instruction set, the loader picks.
// For loops that the compiler turns into vectors by itself; nothing here is fused or reordered
// (-ffp-contract=off), so every copy gives the same bits. Functions that it calls are not copied.
//
// The sanitizers' start-up cannot run such a choice, and other compilers and machines get the plain
// copy.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)
#define TRIBENCH_EACH_LEVEL \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define TRIBENCH_EACH_LEVEL
#endif
