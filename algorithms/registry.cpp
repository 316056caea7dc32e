// SPDX-License-Identifier: MIT
#include "algorithms/registry.hpp"

#include <fmt/format.h>

#include <utility>

#include "algorithms/closed_loop/closed_loop.hpp"
#include "algorithms/model_based/bam_models.hpp"
#include "algorithms/model_based/branch_polynomial.hpp"
#include "algorithms/model_based/dynamic_friction.hpp"
#include "algorithms/model_based/placebos.hpp"
#include "algorithms/model_based/random_search.hpp"
#include "algorithms/model_based/static_friction.hpp"
#include "algorithms/parfam/parfam.hpp"
#include "algorithms/pysr/pysr.hpp"
#include "algorithms/relay/relay.hpp"
#include "algorithms/udsr/udsr.hpp"
#include "foundation/error.hpp"
#include "foundation/suggestion.hpp"

namespace tribench {

static_assert(kMostInputs == kMaxInputs, "a problem has as many inputs as a formula can name");

Registry::Registry() {
  entries_.push_back(symmetric_entry());
  entries_.push_back(asymmetric_entry());
  entries_.push_back(branch_polynomial_entry());
  for (AlgorithmEntry& entry : bam_entries()) entries_.push_back(std::move(entry));
  entries_.push_back(dahl_entry());
  entries_.push_back(lugre_entry());
  entries_.push_back(maxwell_slip_entry());
  entries_.push_back(constant_entry());
  entries_.push_back(linear_entry());
  entries_.push_back(random_search_entry());
  entries_.push_back(closed_loop_entry());
  entries_.push_back(pysr_entry());
  entries_.push_back(parfam_entry());
  entries_.push_back(udsr_entry());
  entries_.push_back(relay_entry());
}

const AlgorithmEntry& Registry::find(std::string_view name) const {
  std::vector<std::string> names;
  for (const AlgorithmEntry& entry : entries_) {
    if (entry.name == name) return entry;
    names.push_back(entry.name);
  }
  throw_bad_input(fmt::format("there is no algorithm '{}'", name), {}, did_you_mean(name, names));
}

std::unique_ptr<Regressor> Registry::make(std::string_view name,
                                          const std::map<std::string, ParameterValue>& given,
                                          int round) const {
  const AlgorithmEntry& entry = find(name);
  std::map<std::string, ParameterValue> parameters = given;
  if (round > 0 && entry.widened != nullptr) parameters.merge(entry.widened(round));
  return entry.make(at_place(fmt::format("method '{}'", name),
                             [&] { return Parameters(entry.parameters, parameters); }),
                    [this](std::string_view other, int its) { return make(other, {}, its); });
}

}  // namespace tribench
