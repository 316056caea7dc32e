// SPDX-License-Identifier: MIT
#include "harness/catalogue.hpp"

#include <memory>
#include <span>
#include <string>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/text.hpp"
#include "foundation/text.hpp"
#include "problems/user/user_problem_text.hpp"

namespace tribench {
namespace {

suite::Law read_law(const std::string& formula, std::span<const std::string> names) {
  auto law = std::make_shared<const Expression>(parse(formula, names));
  auto evaluator = std::make_shared<Evaluator>();
  return [law, evaluator](std::span<const double> point) {
    return evaluator->evaluate_at(*law, point);
  };
}

}  // namespace

suite::LawReader law_reader() { return read_law; }

Catalogue full_catalogue(const std::optional<std::filesystem::path>& data) {
  return Catalogue(data, law_reader());
}

Catalogue full_catalogue_of(std::string_view data, std::span<const user::UserProblem> own) {
  return Catalogue(data.empty() ? std::nullopt : std::optional<std::filesystem::path>(data),
                   law_reader(), own);
}

Catalogue full_catalogue_of_run(const std::filesystem::path& folder, std::string_view data) {
  const std::filesystem::path file = folder / "grid.toml";
  const std::string text = read_file_if_there(file).value_or("");
  return full_catalogue_of(data, user::parse_user_problems(text, file.string(), folder));
}

}  // namespace tribench
