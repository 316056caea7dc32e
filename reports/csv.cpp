// SPDX-License-Identifier: MIT
#include "reports/csv.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <istream>
#include <limits>

namespace tribench {
namespace {

constexpr std::size_t kChunk = 1U << 16U;
constexpr std::size_t kComplaintsKept = 20;

// Splits a stream into rows, keeping quoted line ends inside their field.
class RowReader {
 public:
  explicit RowReader(std::istream& in) : in_(in), chunk_(kChunk, '\0') {}

  // False at the end of the stream. `torn`: the row's line end or closing quote is missing.
  bool next(std::vector<std::string_view>& fields, bool& torn) {
    text_.clear();
    ends_.clear();
    bool quoted = false;
    bool any = false;
    torn = false;
    for (;;) {
      const int c = get();
      if (c < 0) break;
      any = true;
      const char character = static_cast<char>(c);
      if (quoted) {
        quoted = inside_quotes(character);
        continue;
      }
      if (character == '"') {
        quoted = true;
      } else if (character == ',') {
        ends_.push_back(text_.size());
      } else if (character == '\n') {
        ++line_;
        return finish(fields);
      } else if (character != '\r') {
        text_.push_back(character);
      }
    }
    torn = any;
    return any && finish(fields);
  }

  std::size_t line() const { return line_; }
  bool at_blank_line() const { return text_.empty() && ends_.size() == 1; }

 private:
  // A doubled quote is a quote; a single one ends the quoted part.
  bool inside_quotes(char character) {
    if (character == '\n') ++line_;
    if (character != '"') {
      text_.push_back(character);
      return true;
    }
    if (peek() != '"') return false;
    get();
    text_.push_back('"');
    return true;
  }

  bool finish(std::vector<std::string_view>& fields) {
    ends_.push_back(text_.size());
    fields.clear();
    std::size_t begin = 0;
    for (const std::size_t end : ends_) {
      fields.push_back(std::string_view(text_).substr(begin, end - begin));
      begin = end;
    }
    return true;
  }

  int peek() {
    if (at_ == filled_) {
      in_.read(chunk_.data(), static_cast<std::streamsize>(chunk_.size()));
      filled_ = static_cast<std::size_t>(in_.gcount());
      at_ = 0;
      if (filled_ == 0) return -1;
    }
    return static_cast<unsigned char>(chunk_[at_]);
  }

  int get() {
    const int c = peek();
    if (c >= 0) ++at_;
    return c;
  }

  std::istream& in_;
  std::string chunk_;
  std::size_t at_ = 0;
  std::size_t filled_ = 0;
  std::size_t line_ = 0;
  std::string text_;
  std::vector<std::size_t> ends_;
};

}  // namespace

void append_csv_field(std::string& line, std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) {
    line += text;
    return;
  }
  line += '"';
  for (const char c : text) {
    if (c == '"') line += '"';
    line += c;
  }
  line += '"';
}

void append_csv_row(std::string& text, std::span<const std::string> fields) {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (i > 0) text += ',';
    append_csv_field(text, fields[i]);
  }
  text += '\n';
}

std::string csv_number(double value) {
  return std::isnan(value) ? std::string() : fmt::format("{}", value);
}

bool read_csv_number(std::string_view text, double& value) {
  if (text.empty()) {
    value = std::numeric_limits<double>::quiet_NaN();
    return true;
  }
  double read = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, read);
  if (error != std::errc() || stop != end) return false;
  value = read;
  return true;
}

void CsvReading::complain(std::string text) {
  ++dropped;
  if (complaints.size() < kComplaintsKept) complaints.push_back(std::move(text));
}

CsvReading read_csv(
    std::istream& in, const std::function<void(const std::vector<std::string_view>&)>& header,
    const std::function<void(const std::vector<std::string_view>&, std::size_t)>& row) {
  CsvReading reading;
  RowReader reader(in);
  std::vector<std::string_view> fields;
  bool torn = false;
  if (!reader.next(fields, torn)) return reading;
  const std::size_t width = fields.size();
  header(fields);
  while (reader.next(fields, torn)) {
    if (reader.at_blank_line() && width > 1) continue;
    const std::size_t line = reader.line() + (torn ? 1 : 0);
    if (fields.size() == width) {
      row(fields, line);
      ++reading.rows;
    } else if (torn) {
      reading.complain(fmt::format("line {}: torn off in its middle; dropped", line));
    } else {
      reading.complain(fmt::format("line {}: {} fields where the header has {}; dropped", line,
                                   fields.size(), width));
    }
  }
  return reading;
}

CsvReading read_csv(std::istream& in,
                    const std::function<void(const std::vector<std::string_view>&)>& header,
                    const std::function<void(const std::vector<std::string_view>&)>& row) {
  return read_csv(
      in, header,
      [&row](const std::vector<std::string_view>& fields, std::size_t /*line*/) { row(fields); });
}

}  // namespace tribench
