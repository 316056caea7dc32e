// SPDX-License-Identifier: MIT
#include "reports/record.hpp"

namespace tribench {

void forget_costs(Record& record) {
  for (double Record::*cost : {&Record::fit_cpu_s, &Record::fit_wall_s, &Record::fit_instructions,
                               &Record::peak_memory_mib, &Record::eval_ns_per_row}) {
    record.*cost = kMissing;
  }
}

}  // namespace tribench
