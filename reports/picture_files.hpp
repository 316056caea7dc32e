// SPDX-License-Identifier: MIT
//
// Pictures of a page as files: the page's own scripts, run in node, write each as SVG;
// rsvg-convert (librsvg) makes the PNG beside it.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace tribench {

// For before the work: makes the folder, and throws Error (failed) with the package to install
// where a program that draws is not there.
void make_picture_folder(const std::filesystem::path& folder);

// scripts: what follows Vega and plots.js; the last one reads its data from the file named first
// and writes into the folder named second, or only the files named after it, and prints each name.
// Returns the names. Throws Error (failed) where node cannot be started, with the package to
// install.
std::vector<std::string> draw_picture_files(const std::vector<std::string_view>& scripts,
                                            const nlohmann::ordered_json& data,
                                            const std::filesystem::path& folder,
                                            const std::vector<std::string>& only);

// A PNG of twice the size beside each of these SVG files; returns their names. Throws Error
// (failed) where rsvg-convert cannot be started, with the package to install.
std::vector<std::string> write_png_beside(const std::filesystem::path& folder,
                                          const std::vector<std::string>& svg);

}  // namespace tribench
