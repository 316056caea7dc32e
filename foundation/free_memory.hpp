// SPDX-License-Identifier: MIT
//
// The memory that the machine has left. A file that unpacks to more, a grid of millions of cells, a
// recording of a day at a thousand rows a second: where they are too much, an allocation fails and
// the program says so, instead of being ended by the kernel, or of ending others.
//
// For a program's start; programs that it starts inherit the limit, workers set their own. Linux
// only. No result depends on it.
#pragma once

#include <cstdint>
#include <filesystem>

namespace tribench {

// Bytes that may be had without swapping, also where a control group of this process (v1 or v2)
// allows less than the machine has. 0 where nothing tells. root: of /proc and /sys, for tests.
std::uint64_t free_memory(const std::filesystem::path& root = "/");

// From now on allocations beyond the free memory throw std::bad_alloc (RLIMIT_DATA: of memory that
// is asked for, used or not). A lower limit that is there stays.
void hold_to_free_memory();

}  // namespace tribench
