// SPDX-License-Identifier: MIT
//
// Options whose value is one of a few words. Help, documents and completion show the words. For
// numbers: number_options.hpp; for names of `tribench list`: the command looks them up itself.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

namespace tribench {

// The words, in the order to be shown, with the numbers that CLI11 makes an enumerator of.
CLI::Validator one_of(std::vector<std::pair<std::string, int>> choices);

// take_one_of(command->add_option("--level", level, "..."), {{"easy", Level::easy}, ...}): any
// other text is refused with the words.
template <typename Choice>
CLI::Option* take_one_of(CLI::Option* option,
                         const std::vector<std::pair<std::string, Choice>>& choices) {
  std::vector<std::pair<std::string, int>> numbers;
  for (const auto& [word, choice] : choices) numbers.emplace_back(word, static_cast<int>(choice));
  return option->type_name("TEXT")->transform(one_of(std::move(numbers)));
}

}  // namespace tribench
