// SPDX-License-Identifier: MIT
//
// Pages as a browser shows them. Tests that need one: if (!has_browser()) GTEST_SKIP() << ...;
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace tribench {

bool has_browser();

// Appends a script to the page, opens it in a browser without a network and returns what the
// script left in `window.answer`; null where there is no answer. The window's size in pixels.
nlohmann::json asked_in_browser(const std::filesystem::path& page, const std::string& script,
                                const std::string& window = "1300,1000");

// What every look at a page needs: all pictures drawn, then a question.
std::string looking(const std::string& question);

}  // namespace tribench
