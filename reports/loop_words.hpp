// SPDX-License-Identifier: MIT
//
// A closed loop's findings in plain words, once for the terminal, loop.md and the page: what is
// missing, how much it matters, how sure it is, what next. No name of a family, no code of an
// experiment and no p value is in them; those are details.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "reports/record/loop_record.hpp"

namespace tribench {

inline constexpr int kLoopDigits = 4;  // of the figures of a diagnosis

// A unit with the prefix in which figures of this size are read: 0.00014 N m -> 0.14 mN m.
struct LoopUnit {
  double factor = 1;
  std::string name;
};
// size: of the largest figure. Only m (of lengths) .. V take a prefix; others stay as they are.
LoopUnit readable_unit(std::string_view unit, double size);
// The same of an axis, where lengths are read in mm up to 10 cm.
LoopUnit length_unit(std::string_view unit, double size);

// One effect for someone who decides. Texts are sentences; those that do not apply are empty.
struct LoopCard {
  std::string family;
  std::string title;     // "Friction falls with speed near standstill"
  std::string noun;      // "Stribeck effect"
  std::string amount;    // "0.755 N"
  std::string share;     // "4 % of the friction"
  std::string grade;     // "very sure", "likely", "provisional"
  std::string sure;      // "Found again in 40 % of the searches with movements left out."
  std::string bristles;  // of presliding: how stiff, and from where on it slides
  std::vector<std::string> doubts;
  std::string rivals;  // "It could also be ... ."
  std::string settle;  // "To settle it: ... ."
};

struct LoopWords {
  std::string headline;  // what is missing
  std::string error;     // how much it matters
  std::vector<LoopCard> cards;
  std::string leftover;             // where what is still unexplained lives
  std::string next;                 // what to do next
  std::string detectable;           // where nothing was found: what would have been, and where not
  std::vector<std::string> needed;  // where the data cannot tell: what to record
  std::string unused;               // columns without a role that explain what is left over
  std::vector<std::string> untestable;  // what these data cannot show, by reason
  std::vector<std::string> aliased;     // what they cannot tell apart
  std::vector<std::string> bursts;
  std::vector<std::string> remarks;  // warnings about the data, then notes of the search
};

LoopWords loop_words(const LoopRecord& record);

// The unit in which the record's torques are written.
LoopUnit torque_unit(const LoopRecord& record);

// "gravity_torque" -> "gravity torque".
std::string spaced(std::string text);
// The target without its unit: "motor force".
std::string target_words(const LoopRecord& record);

// "load_coulomb" -> "load-dependent Coulomb friction".
std::string family_title(const LoopRecord& record, std::string_view family);
// What it does: "friction falls with speed from standstill (Stribeck)"; the title where it has
// none.
std::string family_phrase(const LoopRecord& record, std::string_view family);
// What differs from movement to movement: "Coulomb friction", "payload"; empty where nothing
// does.
std::string varying_term(const LoopRecord& record);
// A text of the diagnosis without its codes: families by their titles, experiments by what they
// ask for, options and snake_case left out.
std::string plain_text(const LoopRecord& record, std::string text);
// "mu = 0.0682 (0.0621 .. 0.0744)"; for details.
std::string parameter_words(const LoopEffect& effect);
// For reading: sgn(v) for sgn_v, "a - b" for "a + -b".
std::string readable_formula(std::string formula);
// "58 .. 75 %" of the gap to the noise; empty where it is not known.
std::string closed_share(const LoopError& error);

// What an axis is titled with: "speed (rad/s)", "position within 2.5 mm (mm)".
std::string axis_title(const LoopAxis& axis, const LoopUnit& unit);
// "forward", "load about 8.2 A".
std::string split_words(const LoopSeries& series, std::string_view load_unit);

// What the terminal shows: at most twelve lines, the most important first. colour: with escapes.
std::string loop_terminal(const LoopRecord& record, bool colour);

}  // namespace tribench
