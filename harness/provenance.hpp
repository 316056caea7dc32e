// SPDX-License-Identifier: MIT
//
// What a run was made with.
#pragma once

#include <string_view>

namespace tribench {

std::string_view version();

}  // namespace tribench
