// SPDX-License-Identifier: MIT
#include "foundation/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "foundation/error.hpp"

namespace tribench {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n\v\f";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> pieces;
  if (trimmed(text).empty()) return pieces;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.find(separator, start), text.size());
    pieces.emplace_back(trimmed(text.substr(start, end - start)));
    start = end + 1;
  }
  return pieces;
}

std::optional<std::string> read_file_if_there(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) return std::nullopt;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(stream), {});
}

std::string read_file(const std::filesystem::path& file) {
  if (std::optional<std::string> text = read_file_if_there(file)) return *std::move(text);
  throw_bad_input("the file cannot be read", file.string(), "is the path right?");
}

}  // namespace tribench
