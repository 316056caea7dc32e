// SPDX-License-Identifier: MIT
//
// What a method of diagnosis says of a planted case, and what that is worth against the truth. The
// method says what it found; every figure is computed here.
//
// Source: the specification of the closed loop, section 6.2.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/study/loop_cases.hpp"
#include "harness/study/naive_tests.hpp"
#include "problems/kuka/planted.hpp"

namespace tribench {

struct LoopAnswer {
  struct Effect {
    std::string family;
    std::vector<std::string> aliases;  // what else it could be
    bool another_shape = false;        // this cause, but no shape of the library is its own
    double stiffness = 0;              // of bristles, where it says one; the data's unit
    double stiffness_low = 0;          // its 95 % interval
    double stiffness_high = 0;
  };
  struct Burst {
    int movement = 0;
    double begin_s = 0;
    double end_s = 0;
  };
  std::vector<Effect> effects;      // the first found first
  bool unknown = false;             // something is missing that is not in the library
  std::vector<std::string> inputs;  // where that lives, as role names
  std::vector<Burst> bursts;
  // Predictions of the target, per row of the data; NaN where the row is not to be judged.
  std::vector<double> before;
  std::vector<double> after;
  std::vector<double> with_state;  // with bristles as a state; as `after` where there are none
};

// What an answer is worth against the truth.
enum class Says {
  exact,          // the planted causes and nothing else, UNKNOWN where no library has it
  another_shape,  // the same, a cause of them as "this cause, another shape"
  with_unknown,   // the planted causes, and UNKNOWN beside them
  with_more,      // the planted causes, and a wrong one beside them
  partly,         // some of the planted causes, nothing wrong
  alias,          // a wrong name whose aliases hold the truth
  wrong,          // a wrong name, the truth among no aliases, nothing UNKNOWN
  unknown,        // UNKNOWN, where a library has it
  nothing,        // something is missing, and the answer is NONE
};
std::string_view says_name(Says says);
// Throws Error (bad_input).
Says find_says(std::string_view name);
inline constexpr std::array kSays = {Says::exact,     Says::another_shape, Says::with_unknown,
                                     Says::with_more, Says::partly,        Says::alias,
                                     Says::wrong,     Says::unknown,       Says::nothing};

struct LoopOutcome {
  std::string key;
  std::string group;
  std::string noise;  // of simulated campaigns
  std::string design;
  double scale = 0;
  std::uint64_t seed = 0;
  std::vector<std::string> planted;
  std::vector<std::string> claimed;
  std::vector<std::string> aliases;  // of all that is claimed
  bool unknown = false;
  std::vector<std::string> inputs;
  std::size_t events = 0;
  std::size_t bursts = 0;
  std::size_t bursts_found = 0;
  double mae_before = 0;
  double mae_after = 0;
  double mae_state = 0;  // as mae_after, bristles as a state
  double mae_noise = 0;  // the ceiling: of the noise on the rows that were judged
  NaiveFindings naive;   // of the null runs
  Says says = Says::exact;
  double stiffness = 0;       // of planted bristles; 0: none planted
  double said_stiffness = 0;  // 0: none said
  double said_low = 0;        // the interval said with it
  double said_high = 0;
  bool located = false;  // UNKNOWN in the inputs in which the one effect lives
  double cpu_s = 0;

  // The one effect that was planted; empty where it was none or two.
  std::string_view family() const { return planted.size() == 1 ? planted[0] : std::string_view(); }
  bool is_any() const { return unknown || !claimed.empty(); }
  std::size_t right() const;    // planted effects that are claimed
  bool is_covered() const;      // each planted effect is claimed or an alias of a claim
  bool is_first_right() const;  // the first claim was planted
  bool is_exact() const { return says == Says::exact; }
  bool is_wrong() const;  // a wrong claim, the truth in no alias set, no UNKNOWN
  // A simulated campaign's cause; of others what was planted.
  std::string_view cause() const { return planted.empty() ? "none" : std::string_view(planted[0]); }
};

// By its families, aliases and `unknown` alone.
Says judge_story(const LoopAnswer& answer, const std::vector<PlantedEffect>& effects);

LoopOutcome judge_answer(const LoopCase& one, const LoopAnswer& answer, const PlantedData& planted);

// One line of CSV an outcome.
inline constexpr std::array<std::string_view, 27> kOutcomeColumns = {
    "case",           "group",        "noise",      "design",    "scale",     "seed",
    "planted",        "claimed",      "aliases",    "unknown",   "inputs",    "events",
    "bursts",         "bursts_found", "mae_before", "mae_after", "mae_noise", "naive_f_test",
    "naive_bic",      "says",         "located",    "cpu_s",     "mae_state", "stiffness",
    "said_stiffness", "said_low",     "said_high"};
std::string outcome_row(const LoopOutcome& outcome);
// Throws Error (bad_input) where a field is no number.
LoopOutcome read_outcome(std::span<const std::string_view> fields);

}  // namespace tribench
