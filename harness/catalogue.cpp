// SPDX-License-Identifier: MIT
#include "harness/catalogue.hpp"

#include <memory>
#include <span>
#include <string>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/text.hpp"

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

Catalogue full_catalogue_of(std::string_view data) {
  return full_catalogue(data.empty() ? std::nullopt : std::optional<std::filesystem::path>(data));
}

}  // namespace tribench
