// SPDX-License-Identifier: MIT
#include "reports/loop_report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "reports/html/html_report.hpp"
#include "reports/loop_words.hpp"
#include "reports/record_csv.hpp"

namespace tribench {

std::string loop_html(const nlohmann::json& loop, const std::string& title) {
  const nlohmann::json effects = items_of(loop, "effects");
  nlohmann::ordered_json sentences = nlohmann::ordered_json::array();
  for (const nlohmann::json& effect : effects) sentences.push_back(effect_sentence(effect, loop));
  const std::string leftover = leftover_sentence(loop);
  if (!leftover.empty()) sentences.push_back(leftover);
  const std::string heading = fmt::format("Closing the loop: {}", title);
  const nlohmann::ordered_json data = {
      {"title", heading},
      {"verdict", verdict_sentence(loop)},
      {"sentences", std::move(sentences)},
      {"lists",
       {{{"title", "What these data cannot show"}, {"lines", untestable_sentences(loop)}},
        {{"title", "What these data cannot tell apart"}, {"lines", aliased_sentences(loop)}},
        {{"title", "Bursts, left out of every fit and no friction"},
         {"lines", event_sentences(loop)}},
        {{"title", "Remarks"}, {"lines", remarks(loop)}}}},
      {"loop", loop.is_object() ? loop : nlohmann::json::object()}};
  return html_page(heading, PageKind::loop, data);
}

void write_loop_report(const nlohmann::json& loop, const std::string& title,
                       const std::filesystem::path& folder) {
  write_file(folder / "loop.md", loop_markdown(loop, title));
  write_file(folder / "loop.html", loop_html(loop, title));
}

}  // namespace tribench
