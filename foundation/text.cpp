// SPDX-License-Identifier: MIT
#include "foundation/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdint>

#include "foundation/error.hpp"

namespace tribench {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n\v\f";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::string capitalised(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

std::string in_small_letters(std::string_view text) {
  std::string result;
  for (const char c : text) {
    result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return result;
}

namespace {

// Of the control character at the start of a text; 0: there is none. U+0080 to U+009F are two
// bytes.
std::size_t control_length(std::string_view text) {
  const auto byte = static_cast<unsigned char>(text[0]);
  if (byte < 0x20 || byte == 0x7F) return 1;
  if (byte != 0xC2 || text.size() < 2) return 0;
  const auto next = static_cast<unsigned char>(text[1]);
  return next >= 0x80 && next < 0xA0 ? 2 : 0;
}

// Bytes of the UTF-8 sequence that begins at `at`; 0: none does.
std::size_t utf8_sequence(std::string_view text, std::size_t at) {
  const auto first = static_cast<unsigned char>(text[at]);
  const std::size_t size = first < 0x80                     ? 1
                           : first >= 0xC2 && first < 0xE0  ? 2
                           : first >= 0xE0 && first < 0xF0  ? 3
                           : first >= 0xF0 && first <= 0xF4 ? 4
                                                            : 0;
  if (at + size > text.size()) return 0;
  for (std::size_t i = 1; i < size; ++i) {
    if ((static_cast<unsigned char>(text[at + i]) & 0xC0) != 0x80) return 0;
  }
  if (size < 3) return size;
  const auto second = static_cast<unsigned char>(text[at + 1]);
  const bool is_overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
  const bool is_half_or_beyond =
      (first == 0xED && second >= 0xA0) || (first == 0xF4 && second >= 0x90);
  return is_overlong || is_half_or_beyond ? 0 : size;
}

}  // namespace

bool is_utf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t size = utf8_sequence(text, at);
    if (size == 0) return false;
    at += size;
  }
  return true;
}

bool holds_control_characters(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (control_length(text.substr(i)) > 0) return true;
  }
  return false;
}

std::string without_control_characters(std::string_view text) {
  std::string shown;
  while (!text.empty()) {
    const std::size_t control = control_length(text);
    const bool is_blank = text[0] >= '\t' && text[0] <= '\r';
    shown += control == 0 ? text[0] : is_blank ? ' ' : '?';
    text.remove_prefix(std::max<std::size_t>(control, 1));
  }
  return shown;
}

std::string lines_without_control_characters(std::string_view text) {
  std::string shown;
  for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n')) {
    shown += without_control_characters(text.substr(0, end)) + '\n';
    text.remove_prefix(end + 1);
  }
  return shown + without_control_characters(text);
}

std::string clipped(std::string_view text, std::size_t most) {
  if (text.size() <= most) return std::string(text);
  const auto goes_on = [&](std::size_t at) {
    return (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U;
  };
  std::size_t end = most;
  while (end > 0 && goes_on(end)) --end;
  return std::string(text.substr(0, end)) + "...";
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

namespace {

constexpr std::size_t kBlock = 65536;

[[noreturn]] void refuse_length(const std::filesystem::path& file, std::size_t largest) {
  throw_bad_input(fmt::format("it is longer than {} bytes", largest), file.string(),
                  "is it the right file? give a part of it");
}

// What a device gives before it is read on: zeros and random bytes are no text, UTF-16 with its
// mark and what gzip packed may hold one.
bool may_be_text(std::string_view start) {
  constexpr std::size_t kOneInTwenty = 20;
  for (const std::string_view mark : {"\x1F\x8B", "\xFF\xFE", "\xFE\xFF"}) {
    if (start.starts_with(mark)) return true;
  }
  const auto is_control = [](unsigned char c) { return c == 127 || (c < 32 && !std::isspace(c)); };
  return kOneInTwenty * static_cast<std::size_t>(std::ranges::count_if(start, is_control)) <=
         start.size();
}

}  // namespace

std::vector<std::string> words_of_command(std::string_view text, std::string_view place) {
  std::vector<std::string> words;
  char quote = 0;
  bool inside = false;
  for (const char c : text) {
    if (quote != 0 ? c == quote : (c == '\'' || c == '"')) {
      quote = quote != 0 ? 0 : c;
      if (!inside) words.emplace_back();
      inside = true;
    } else if (c == ' ' && quote == 0) {
      inside = false;
    } else {
      if (!inside) words.emplace_back();
      inside = true;
      words.back() += c;
    }
  }
  if (quote != 0 || words.empty()) {
    throw_bad_input(fmt::format("'{}' is no command", text), place,
                    fmt::format("as in {} 'python3 mine.py'", place));
  }
  return words;
}

std::string read_file(const std::filesystem::path& file, std::size_t largest) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) {
    throw_bad_input("this is a folder", file.string(), "give a file");
  }
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw_bad_input("the file cannot be read", file.string(), "is the path right?");
  // A pipe has no size, and one below /proc is 0: what is there is read until it ends.
  const bool has_end = std::filesystem::is_regular_file(file, ignored);
  const std::uintmax_t size = has_end ? std::filesystem::file_size(file, ignored) : 0;
  if (size > largest) refuse_length(file, largest);
  std::string text(std::max<std::size_t>(size + 1, kBlock), '\0');
  std::size_t filled = 0;
  while (true) {
    stream.read(text.data() + filled, static_cast<std::streamsize>(text.size() - filled));
    filled += static_cast<std::size_t>(stream.gcount());
    if (!stream) break;
    if (!has_end && filled == kBlock && !may_be_text(text)) {
      throw_bad_input("what it gives is no text", file.string(), "give a file");
    }
    if (filled > largest) refuse_length(file, largest);
    text.resize(2 * filled);
  }
  if (stream.bad()) throw Error(ErrorKind::failed, "reading stopped half way", file.string());
  if (filled > largest) refuse_length(file, largest);
  text.resize(filled);
  return text;
}

std::optional<std::string> read_file_if_there(const std::filesystem::path& file) {
  if (!open_file_if_there(file)) return std::nullopt;
  return read_file(file);
}

std::ifstream open_file_if_there(const std::filesystem::path& file) {
  std::error_code ignored;
  std::ifstream stream;
  stream.setstate(std::ios::failbit);
  if (!std::filesystem::is_regular_file(file, ignored)) return stream;
  stream.clear();
  stream.open(file, std::ios::binary);
  return stream;
}

}  // namespace tribench
