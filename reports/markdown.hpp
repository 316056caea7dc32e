// SPDX-License-Identifier: MIT
//
// Markdown that reads well raw and on a code host: padded tables, `|` in cells escaped.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tribench {

enum class Align { left, right };

class MarkdownTable {
 public:
  struct Heading {
    std::string text;
    Align align = Align::left;
  };
  explicit MarkdownTable(std::vector<Heading> headings) : headings_(std::move(headings)) {}
  // As many cells as headings.
  void add(std::vector<std::string> cells);
  std::string text() const;  // ends in a newline
  bool empty() const { return rows_.empty(); }

 private:
  std::vector<Heading> headings_;
  std::vector<std::vector<std::string>> rows_;
};

// Columns that a text takes on the screen: code points, not bytes.
std::size_t display_width(std::string_view utf8);

// Cut to `width` code points with "..." at the end where it is longer.
std::string shortened(std::string_view utf8, std::size_t width);

// As code: formulas hold * and ^ and |, which Markdown would eat.
std::string markdown_code(std::string_view text);

// A page with words from outside in it (names of columns, files and movements): none of them is a
// tag, and control characters but line ends are gone.
std::string without_tags(std::string_view page);

}  // namespace tribench
