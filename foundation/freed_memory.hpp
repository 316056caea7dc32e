// SPDX-License-Identifier: MIT
//
// What the heap does with memory that is freed. A search frees some megabytes and asks for as many
// a moment later; where each goes back to the system, the pages are mapped and filled with zeros
// anew every time, which took a sixth of a loop's seconds and two fifths of an exploration's.
//
// For a program's start, not for a library: it is one setting for the whole process. Not for
// workers, whose cells are told the memory they need: it would hold what earlier cells left. glibc
// only; elsewhere nothing happens. No result depends on it.
#pragma once

namespace tribench {

// From now on freed memory stays with the process, and what is asked for up to a gigabyte comes
// from it.
void keep_freed_memory();

}  // namespace tribench
