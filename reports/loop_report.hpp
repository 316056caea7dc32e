// SPDX-License-Identifier: MIT
//
// What people read about a closed loop: loop.md and loop.html, and its pictures as files, from its
// record alone. Nothing is computed here that the diagnosis has not decided. The sentences are
// those of loop_words.hpp, the pictures those of html/loop_page.hpp.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "reports/record/loop_record.hpp"

namespace tribench {

// At most 120 lines: the answer, then figures in tables; long lists end where loop.json has more.
std::string loop_markdown(const LoopRecord& record);

// One self-contained page with the pictures.
std::string loop_html(const LoopRecord& record);

// Writes loop.json, loop.md and loop.html into the folder. Throws Error (failed) where they cannot
// be written.
void write_loop_report(const LoopRecord& record, const std::filesystem::path& folder);

// Every picture of the page as SVG and PNG; returns the files' names. Throws Error (failed) where
// node or rsvg-convert are missing, with the package to install.
std::vector<std::string> write_loop_pictures(const LoopRecord& record,
                                             const std::filesystem::path& folder);

}  // namespace tribench
