// SPDX-License-Identifier: MIT
#define TRIBENCH_LANE_BYTES 32
#include "foundation/elementary/column_table.hpp"

namespace tribench::elementary {

constinit const ColumnTable kColumnFma = kColumnTable;

}  // namespace tribench::elementary
