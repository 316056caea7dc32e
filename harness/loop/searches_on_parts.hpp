// SPDX-License-Identifier: MIT
//
// The search of a campaign and the same without some of its movements: what most of these say is
// named, whatever hangs on a movement or two is not. Not for errors (loop_judge.hpp).
//
// Source: stability selection, Meinshausen and Buehlmann 2010.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "harness/loop/judged_diagnosis.hpp"

namespace tribench::loop {

class SearchesOnParts {
 public:
  // without: the movements that the search which is reported has not seen, ascending. parts: more
  // of them, a search each. All arguments are kept by reference but the movements.
  SearchesOnParts(const Observations& data, const BaseMaker& base, const DiagnosisOptions& options,
                  const JudgingOptions& judging, const std::vector<int>& without,
                  const std::vector<std::vector<int>>& parts);

  void search_all();
  // Those on parts are given up where the whole says that nothing is missing. They begin before
  // that is known; what has become of them is forgotten.
  void search_until_none();

  // Takes from the answers the effects that fewer than kStableShare of the searches on parts
  // choose, and writes the shares of the others and of what is left over. Returns what to record to
  // be sure of what is not named. Nothing where there are no parts.
  std::vector<std::string> name_the_stable();

  Diagnosis& whole() { return found_.front(); }
  std::span<Diagnosis> parts() { return std::span(found_).subspan(1); }

 private:
  void search(const std::vector<std::size_t>& which, const DiagnosisOptions& options,
              bool until_none);

  const Observations& data_;
  const BaseMaker& base_;
  const DiagnosisOptions& options_;
  const JudgingOptions& judging_;
  std::vector<std::vector<int>> without_;  // of each search, the reported one first
  std::vector<Diagnosis> found_;
  std::vector<SearchMemory> memories_;
  std::size_t ended_ = 0;  // searches, of those asked for
  std::size_t asked_ = 0;
};

}  // namespace tribench::loop
