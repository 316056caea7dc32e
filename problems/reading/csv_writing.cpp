// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <iterator>
#include <ostream>

#include "foundation/output_file.hpp"
#include "problems/reading/csv.hpp"

namespace tribench {
namespace {

std::string quoted(const std::string& cell) {
  if (cell.find_first_of(",;\t\"\n\r") == std::string::npos && !cell.empty() &&
      cell.front() != ' ' && cell.back() != ' ') {
    return cell;
  }
  std::string text = "\"";
  for (const char c : cell) {
    if (c == '"') text += '"';
    text += c;
  }
  return text + '"';
}

fmt::memory_buffer csv_text(const Dataset& data) {
  fmt::memory_buffer buffer;
  buffer.append(std::string_view("movement"));
  for (const Channel& channel : data.channels) {
    fmt::format_to(std::back_inserter(buffer), ",{}", quoted(channel.name));
  }
  buffer.push_back('\n');
  for (std::size_t r = 0; r < data.rows(); ++r) {
    const auto movement = static_cast<std::size_t>(data.movement[r]);
    buffer.append(std::string_view(quoted(data.movement_names[movement])));
    for (const Channel& channel : data.channels) {
      fmt::format_to(std::back_inserter(buffer), ",{}", channel.values[r]);
    }
    buffer.push_back('\n');
  }
  return buffer;
}

}  // namespace

void write_csv(const Dataset& data, std::ostream& out) {
  const fmt::memory_buffer text = csv_text(data);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
}

void write_csv(const Dataset& data, const std::filesystem::path& file) {
  const fmt::memory_buffer text = csv_text(data);
  write_file(file, {text.data(), text.size()});
}

}  // namespace tribench
