// SPDX-License-Identifier: MIT
#include "harness/cli/choice_option.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tribench {

CLI::Validator one_of(std::vector<std::pair<std::string, int>> choices) {
  std::vector<std::string> words;
  for (const auto& choice : choices) words.push_back(choice.first);
  // As CLI11 writes it, and command_tree.cpp reads it.
  const std::string shown = fmt::format("{{{}}}", fmt::join(words, ","));
  return {[choices = std::move(choices), words](std::string& text) -> std::string {
            const auto found =
                std::ranges::find(choices, text, &std::pair<std::string, int>::first);
            if (found == choices.end()) {
              return fmt::format("'{}' cannot be used; use {}", text, fmt::join(words, ", "));
            }
            text = std::to_string(found->second);
            return {};
          },
          shown};
}

}  // namespace tribench
