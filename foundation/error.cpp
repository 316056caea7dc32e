// SPDX-License-Identifier: MIT
#include "foundation/error.hpp"

#include <fmt/format.h>

namespace tribench {
namespace {

std::string compose(std::string_view what, std::string_view place, std::string_view mend) {
  std::string text = place.empty() ? std::string(what) : fmt::format("{}: {}", place, what);
  if (!mend.empty()) text += fmt::format("; {}", mend);
  return text;
}

}  // namespace

Error::Error(ErrorKind kind, std::string_view what, std::string_view place, std::string_view mend)
    : std::runtime_error(compose(what, place, mend)), kind_(kind), place_(place), mend_(mend) {}

void throw_bad_input(std::string_view what, std::string_view place, std::string_view mend) {
  throw Error(ErrorKind::bad_input, what, place, mend);
}

}  // namespace tribench
