// SPDX-License-Identifier: MIT
//
// Words of a command line as a shell reads them back: for scripts that are written and commands
// that are shown. Programs are run without a shell (child_process.hpp).
#pragma once

#include <string>
#include <string_view>

namespace tribench {

// As it is where a POSIX shell takes it literally, else in single quotes.
std::string shell_word(std::string_view word);

}  // namespace tribench
