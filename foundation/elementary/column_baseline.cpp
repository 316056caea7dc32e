// SPDX-License-Identifier: MIT
#define TRIBENCH_LANE_BYTES 16
#include "foundation/elementary/column_table.hpp"

namespace tribench::elementary {

constinit const ColumnTable kColumnBaseline = kColumnTable;

}  // namespace tribench::elementary
