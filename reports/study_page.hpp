// SPDX-License-Identifier: MIT
//
// A run as a page that can be cited: how it was made (command, machine, budgets, settings of every
// method), published figures beside ours, proofs, sensitivity, and what the caller adds. Generated
// as a whole; nothing in it is written by hand.
#pragma once

#include <filesystem>
#include <string>

#include "reports/run_folder.hpp"
#include "reports/summary.hpp"

namespace tribench {

struct StudyPage {
  std::string sections;  // Markdown of the caller's, with headings of level 2, after the figures
  std::vector<std::string> pictures;  // paths from the page, shown in this order
};

std::string study_page(const RunFolder& run, const RunSummary& summary, const StudyPage& extra);

// Reads the folder and writes the page, with the pictures it shows beside it in a folder of the
// page's name ("paper/" beside "paper.md"), where node is there to draw them. `sections`: as above.
void write_study_page(const std::filesystem::path& folder, const std::filesystem::path& page,
                      const std::string& sections);

}  // namespace tribench
