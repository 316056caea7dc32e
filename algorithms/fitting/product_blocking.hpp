// SPDX-License-Identifier: MIT
//
// Products of large matrices give the same bits on every machine. Eigen cuts them into blocks that
// fit the caches it finds, so that sums over more than some 250 rows are added in another order
// where the first cache has 48 KiB instead of 32.
//
// Not for speed: the sizes are those of a common machine.
#pragma once

namespace tribench {

// For the whole process, before its first product; calling it again changes nothing. Whoever uses
// the libraries without the program calls it where bits are to be compared with the program's.
void pin_product_blocking();

}  // namespace tribench
