// SPDX-License-Identifier: MIT
//
// Self-contained pages: scripts, styles and fonts are part of the program and go into the file, so
// that it opens from a disk without a network.
//
// Pictures are Vega (libjs-vega), formulas KaTeX (libjs-katex, fonts-katex), both as the
// distribution ships them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace tribench {

enum class PageKind { run, loop };

// data: what the page's script reads; any text in it is shown as text, never run.
std::string html_page(std::string_view title, PageKind kind, const nlohmann::ordered_json& data);

}  // namespace tribench
