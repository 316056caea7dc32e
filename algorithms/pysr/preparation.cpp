// SPDX-License-Identifier: MIT
#include "algorithms/pysr/preparation.hpp"

#include <fmt/format.h>

#include <numeric>
#include <optional>
#include <utility>

#include "algorithms/pysr/denoise.hpp"
#include "algorithms/pysr/feature_selection.hpp"

namespace tribench::pysr {

std::vector<std::string> names_of(std::span<const Input> inputs) {
  std::vector<std::string> names;
  for (const Input& input : inputs) names.push_back(input.name);
  return names;
}

void add_to_note(std::string& note, const std::string& what) {
  if (!note.empty() && !what.empty()) note += "; ";
  note += what;
}

Form prepare_form(const Options& options, const Rows& rows, FitContext& context,
                  std::string& note) {
  const std::vector<std::string> names = names_of(context.data.inputs);
  if (!options.form.empty()) return {options.form, names};
  const auto wanted = static_cast<std::size_t>(options.select_features);
  if (wanted == 0 || wanted >= names.size()) return Form(names.size());
  const std::vector<double> importances =
      forest_importances(rows, names.size(), context.random.split("forest"), context.budget);
  if (importances.empty()) {
    add_to_note(note, "no inputs selected: the budget does not reach");
    return Form(names.size());
  }
  std::vector<std::size_t> chosen = most_important(importances, wanted);
  std::string text;
  for (const std::size_t j : chosen) text += " " + names[j];
  add_to_note(note, "inputs selected:" + text);
  return {names.size(), std::move(chosen)};
}

Rows prepare_rows(const Options& options, const Form& form, const Rows& all, FitContext& context,
                  std::string& note) {
  RandomStream random = context.random.split("sample");
  Rows seen = draw_sample(all, static_cast<std::size_t>(options.search_rows), random);
  if (!options.denoise) return seen;
  std::vector<std::size_t> columns(context.data.inputs.size());
  std::iota(columns.begin(), columns.end(), std::size_t{0});
  if (form.is_whole()) columns.assign(form.arguments(0).begin(), form.arguments(0).end());
  std::optional<Denoised> smoothed =
      denoised(all, seen, columns, context.random.split("denoise"), context.budget);
  if (!smoothed) {
    add_to_note(note, "not denoised: the budget does not reach, or no covariance fits");
    return seen;
  }
  seen.target = std::move(smoothed->target);
  add_to_note(note, fmt::format("denoised: noise {:.3g}", smoothed->noise));
  return seen;
}

}  // namespace tribench::pysr
