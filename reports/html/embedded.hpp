// SPDX-License-Identifier: MIT
//
// The files that the build puts into the program for the pages (cmake/TribenchEmbed.cmake).
#pragma once

#include <string_view>

namespace tribench::embedded {

std::string_view vega_js();
std::string_view katex_js();
std::string_view katex_css();
std::string_view font_main();
std::string_view font_math();
std::string_view font_size1();
std::string_view font_size2();
std::string_view font_size3();
std::string_view font_size4();
std::string_view page_css();
std::string_view formula_js();
std::string_view plots_js();
std::string_view run_plots_js();
std::string_view loop_plots_js();
std::string_view common_js();
std::string_view run_js();
std::string_view loop_js();
std::string_view pictures_js();
std::string_view loop_pictures_js();

}  // namespace tribench::embedded
