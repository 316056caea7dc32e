// SPDX-License-Identifier: MIT
#include "reports/record/loop_record.hpp"

namespace tribench {

std::string_view loop_verdict_name(LoopVerdict verdict) {
  switch (verdict) {
    case LoopVerdict::none:
      return "NONE";
    case LoopVerdict::effects:
      return "EFFECTS";
    case LoopVerdict::unknown:
      return "UNKNOWN";
    case LoopVerdict::cannot_tell:
      break;
  }
  return "CANNOT_TELL";
}

}  // namespace tribench
