// SPDX-License-Identifier: MIT
//
// How often searches on parts of the data choose the effects that the whole does: how sure each is.
// Not for what an effect is worth (loop_judge.hpp).
//
// Source: Meinshausen and Buehlmann 2010 (stability selection); Faletto and Bien 2022 (correlated
// candidates share their votes).
#pragma once

#include <set>
#include <span>
#include <string>
#include <vector>

#include "algorithms/diagnosis/diagnosis.hpp"

namespace tribench::loop {

class ChosenShares {
 public:
  explicit ChosenShares(std::span<const Diagnosis> parts);

  // Of the searches; NaN where there are none.
  double of(const std::string& family) const { return of_any({family}); }
  double of_any(const std::set<std::string>& families) const;

 private:
  std::vector<std::set<std::string>> chosen_;
};

// The effect and what looks like it in these data: searches on parts call one cause by one of these
// names or another.
std::set<std::string> names_of(const EffectFinding& effect);

// Each effect's share; where most searches call it by another name, which.
void write_shares(Diagnosis& whole, const ChosenShares& shares);

}  // namespace tribench::loop
