// SPDX-License-Identifier: MIT
//
// Pages as a browser shows them. Tests that need one: if (!has_browser()) GTEST_SKIP() << ...;
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace tribench {

bool has_browser();

struct Window {
  int width = 1300;  // pixels
  int height = 1000;
};

// What a test asks of a page: a script that is appended to it and leaves its answer in
// `window.answer`. A browser takes seconds to start, so that one shows all pages of a program, each
// in a frame of its window's size and without a network, when the first answer is wanted. Questions
// therefore stand beside the tests and not in them.
class Question {
 public:
  // `make_page` writes the page and says where it lies; it is called when the browser starts.
  Question(std::function<std::filesystem::path()> make_page, std::string script,
           Window window = {});

  // Null where there is no answer.
  nlohmann::json answer() const;

 private:
  std::size_t number_;  // among all questions of the program
};

// What every look at a page needs: all pictures drawn, then a question.
std::string looking(const std::string& question);

}  // namespace tribench
