// SPDX-License-Identifier: MIT
//
// Residual -> missing effect -> refit -> verdict: the procedure of the specification, section 4,
// from observations and a base model to findings. What the model before and after is worth on
// movements that it has not seen is the judge's to say (harness/loop/judged_diagnosis.hpp).
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/campaign/findings.hpp"
#include "algorithms/campaign/options.hpp"
#include "algorithms/inference/noise.hpp"
#include "algorithms/leftover/leftover_finding.hpp"
#include "algorithms/loop_model/loop_model.hpp"
#include "foundation/random.hpp"

namespace tribench::loop {

// Shorter movements are left out.
inline constexpr std::size_t kFewestRowsOfMovement = 5;

// cannot_tell: nothing could be tested, neither the library nor what is left over; or something is
// there that too few movements show.
enum class Verdict { none, effects, unknown, cannot_tell };
// "NONE", "EFFECTS", "UNKNOWN", "CANNOT_TELL"
std::string_view verdict_name(Verdict verdict);

struct ParameterFinding {
  std::string name;
  double value = 0;
  double low = 0;  // 95 %
  double high = 0;
};

struct EffectFinding {
  std::string family;
  std::string phrase;
  std::string atom;  // its columns as written in the library
  int order = 0;     // 1 for the first found
  double adjusted_p = 1;
  double gain = 0;
  double gain_error = 0;
  std::vector<ParameterFinding> parameters;
  double rms_contribution = 0;  // of its torque, beyond what the base can do as well
  double vif = 1;
  std::vector<AliasFinding> aliases;
  std::vector<std::string> separate_by;
  bool few_movements = false;  // carried by few movements: ask for more of them
  // The other effects together can tell nine tenths of it: it may be there because they cancel each
  // other (variance inflation above 10; Marquardt 1970).
  bool told_by_others = false;
  // Shares an input with the leftover, is told by the others, is not physical, or (the judge says
  // that) is not confirmed by the movements left out.
  bool provisional = false;
  std::string objection;  // why it is not physical; empty where it is
  // Shows between movements only, beside something that differs between them: may stand for it.
  bool stands_in = false;
  // This cause, but a curve that the library does not have: more is left over in its own inputs.
  bool another_shape = false;
  // Share of the searches with some movements left out that choose it, or an alias, too; NaN where
  // there are none.
  double chosen_share = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::string> notes;
};

struct CoincidingFamilies {
  std::string first;
  std::string second;
  double correlation = 0;
  std::string separate_by;
};

// Largest correlation of any two columns of two families, given the base; 1 on the diagonal.
struct AliasMap {
  std::vector<std::string> families;
  Eigen::MatrixXd correlation;
};

struct EventFinding {
  int movement = 0;
  std::string movement_name;
  double begin = 0;  // s, or row where there is no time
  double end = 0;
  double peak = 0;  // in the target's unit
};

struct CandidateFinding {
  std::string family;
  std::string atom;
  double adjusted_p = 1;
  double score = 0;
  double gain = std::numeric_limits<double>::quiet_NaN();
  double gain_share = 0;  // of the base's loss on movements left out; 0: no more than its error
  // The root mean square that the median of its curves would have needed to be found nine times in
  // ten, in the target's unit; infinity where too few clusters hold it to be found at any size.
  double detectable = std::numeric_limits<double>::quiet_NaN();
};

struct Diagnosis {
  Verdict verdict = Verdict::none;
  DiagnosisOptions options;
  Noise noise;
  std::size_t rows = 0;
  std::size_t stretches = 0;
  std::size_t movements = 0;
  double correlation_rows = 1;  // how many rows the noise lasts
  std::vector<EffectFinding> effects;
  // Families that the search ended with, before any was taken out or gave way to what is left over:
  // without one of DiagnosisOptions::unnamed among them its answer is the same.
  std::vector<std::string> tried;
  LeftoverFinding leftover;
  std::vector<UntestableFinding> untestable;
  std::vector<CoincidingFamilies> aliased;
  AliasMap alias_map;
  std::vector<EventFinding> events;
  std::vector<CandidateFinding> candidates;  // of the first round
  // In the position's unit, "rad" or "m": what repeats over less is looked for at the gear's own
  // ratios only. NaN where nothing that repeats is looked for.
  double shortest_wave = std::numeric_limits<double>::quiet_NaN();
  std::string shortest_wave_unit;
  std::vector<std::string> needed;  // where it cannot tell: what would be
  std::vector<std::string> notes;
  LoopModel before;  // fitted to the training movements
  LoopModel after;
  std::vector<int> held_out;  // movements it has not looked at, ascending
  std::vector<char> masked;   // per row of the data: part of an event
  std::vector<EffectFamily> families;
};

// Per row 1 for rows of the movements in (or not in) `movements`, which are ascending, without
// those masked and without movements that are too short to say anything.
std::vector<char> usable_rows(const Observations& data, const std::vector<int>& movements,
                              bool in_them, const std::vector<char>& masked);

// What the searches of one diagnosis ended with, before anything was taken out of them. Filled by
// diagnose(), a few model matrices a search.
struct KnownSearches;
using SearchMemory = std::shared_ptr<KnownSearches>;

// held_out: movements to which nothing is fitted and by which nothing is chosen, ascending; bursts
// in them are listed too. Deterministic: no seed decides anything. memory: of an earlier call with
// the same arguments but for DiagnosisOptions::unnamed, or empty; its searches are not made again,
// and the answer is the same.
// Cost: some tens of milliseconds for 6 000 rows. Throws Error (bad_input) where there are too few
// rows to fit the base.
Diagnosis diagnose(const Observations& data, const BaseMaker& base, const DiagnosisOptions& options,
                   const std::vector<int>& held_out = {}, SearchMemory* memory = nullptr);

}  // namespace tribench::loop
