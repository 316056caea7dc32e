// SPDX-License-Identifier: MIT
#include "algorithms/exploration/second_opinion.hpp"

#include <algorithm>
#include <string_view>

namespace tribench::loop {
namespace {

// One of the library's families; a name that the space does not have is of nothing.
class Library {
 public:
  explicit Library(std::span<const ExplainingFamily> families) : families_(families) {}

  bool lives_in(std::string_view name, Role role) const {
    const auto family = std::ranges::find(families_, name, &ExplainingFamily::name);
    return family != families_.end() &&
           std::ranges::count(family->characteristic, role_name(role)) > 0;
  }

 private:
  std::span<const ExplainingFamily> families_;
};

}  // namespace

NamedFamilies diagnosed_families(const Observations& rows, const DiagnosisOptions& options) {
  DiagnosisOptions effects_alone = options;
  effects_alone.compares_families = false;
  const Diagnosis found = diagnose(rows, coulomb_viscous_base, effects_alone);
  NamedFamilies out;
  for (const EffectFinding& effect : found.effects) out.names.push_back(effect.family);
  out.unknown = found.verdict == Verdict::unknown ||
                (found.verdict == Verdict::none && found.noise.is_mostly_between());
  return out;
}

bool bears_out(const NamedFamilies& diagnosed, const NamedFamilies& said,
               std::span<const ExplainingFamily> families) {
  const Library library(families);
  const auto is_said = [&](const std::string& name) {
    return std::ranges::count(said.names, name) > 0;
  };
  const auto all_but_late = [&] {
    std::vector<std::string> names = diagnosed.names;
    const auto is_warm = [&](const std::string& name) {
      return library.lives_in(name, Role::temperature);
    };
    if (std::ranges::none_of(said.names, is_warm)) return names;
    std::erase_if(names, [&](const std::string& name) {
      return !is_said(name) && library.lives_in(name, Role::time);
    });
    return names;
  };
  const std::vector<std::string> names = all_but_late();
  const auto is_transient = [&](const std::string& name) {
    return library.lives_in(name, Role::acceleration);
  };
  const auto are_among = [&](const std::vector<std::string>& some,
                             const std::vector<std::string>& all) {
    return std::ranges::all_of(some, [&](const std::string& name) {
      return std::ranges::count(all, name) > 0 ||
             (is_transient(name) && std::ranges::any_of(all, is_transient));
    });
  };
  return diagnosed.unknown == said.unknown && names.size() == said.names.size() &&
         are_among(names, said.names) && are_among(said.names, names);
}

}  // namespace tribench::loop
