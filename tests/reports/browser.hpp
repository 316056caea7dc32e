// SPDX-License-Identifier: MIT
//
// Pages as a browser shows them. Tests that need one: if (!has_browser()) GTEST_SKIP() << ...;
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tribench {

bool has_browser();

struct Window {
  int width = 1300;  // pixels
  int height = 1000;
};

struct ShownPage {
  std::filesystem::path page;
  Window window;
};

// Appends a script to the page, opens it in a browser without a network and returns what the
// script left in `window.answer`; null where there is no answer.
nlohmann::json asked_in_browser(const std::filesystem::path& page, const std::string& script,
                                Window window = {});

// The same of several pages at once, each in a frame of its window's size: a browser takes seconds
// to start. An array in the pages' order.
nlohmann::json all_asked_in_browser(const std::vector<ShownPage>& pages, const std::string& script);

// What every look at a page needs: all pictures drawn, then a question.
std::string looking(const std::string& question);

}  // namespace tribench
