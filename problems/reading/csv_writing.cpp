// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <ostream>

#include "foundation/error.hpp"
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

}  // namespace

void write_csv(const Dataset& data, std::ostream& out) {
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
  out.write(buffer.data(), static_cast<std::streamsize>(buffer.size()));
}

void write_csv(const Dataset& data, const std::filesystem::path& file) {
  std::ofstream out(file, std::ios::binary);
  if (out) write_csv(data, out);
  out.flush();
  if (!out) {
    throw Error(ErrorKind::failed, "cannot write the file", file.string(),
                "check that the folder exists and is writable");
  }
}

}  // namespace tribench
