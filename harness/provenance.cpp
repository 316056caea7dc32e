// SPDX-License-Identifier: MIT
#include "harness/provenance.hpp"

namespace tribench {

std::string_view version() { return "0.1.0"; }

}  // namespace tribench
