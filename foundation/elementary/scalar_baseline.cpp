// SPDX-License-Identifier: MIT
#define TRIBENCH_LANE_BYTES 16
#include "foundation/elementary/scalar_table.hpp"

namespace tribench::elementary {

constinit const ScalarTable kScalarBaseline = kScalarTable;

}  // namespace tribench::elementary
