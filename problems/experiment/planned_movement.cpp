// SPDX-License-Identifier: MIT
#include "problems/experiment/planned_movement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "foundation/error.hpp"
#include "foundation/suggestion.hpp"
#include "foundation/text.hpp"
#include "problems/reading/csv_cells.hpp"
#include "problems/reading/csv_checks.hpp"

namespace tribench {
namespace {

constexpr double kPeriods = 3;         // of the first tone
constexpr double kTwoToneRatio = 1.9;  // of the second tone's frequency to the first's

const std::vector<std::string>& known_columns() {
  static const std::vector<std::string> kColumns = {"order",
                                                    "kind",
                                                    "velocity_rad_s",
                                                    "from_rad",
                                                    "to_rad",
                                                    "load_factor",
                                                    "duration_s",
                                                    "tone1_rad",
                                                    "tone1_Hz",
                                                    "tone2_rad",
                                                    "tone2_Hz",
                                                    "rest_s",
                                                    "other_velocity_rad_s",
                                                    "separation",
                                                    "between",
                                                    "why"};
  return kColumns;
}

std::string number_or_nothing(double x) {
  return std::isfinite(x) ? fmt::format("{}", x) : std::string();
}

// The cells of one line by the names of their columns.
class MovementLine {
 public:
  MovementLine(const CsvCells& cells, const CsvLine& line, std::string_view file)
      : cells_(cells), line_(line), file_(file) {}

  std::string_view text(std::string_view column) const {
    const auto found = std::ranges::find(cells_.header, column);
    return found == cells_.header.end()
               ? std::string_view()
               : line_.cells[static_cast<std::size_t>(found - cells_.header.begin())];
  }

  double number(std::string_view column, double low, double high) const {
    double value = 0;
    const std::string_view cell = text(column);
    if (read_cell(cell, false, value) != CellKind::number || !(value >= low && value <= high)) {
      throw_bad_input(fmt::format("'{}' is no {}", clipped(cell), column), place(),
                      fmt::format("a number from {:g} to {:g}", low, high));
    }
    return value;
  }
  double number_or(std::string_view column, double value, double low, double high) const {
    return text(column).empty() ? value : number(column, low, high);
  }

  std::string place() const { return fmt::format("{}:{}", file_, line_.number); }

 private:
  const CsvCells& cells_;
  const CsvLine& line_;
  std::string_view file_;
};

void check_header(const CsvCells& cells, std::string_view file) {
  for (const std::string& name : cells.header) {
    if (std::ranges::count(known_columns(), name) > 0) continue;
    if (name.ends_with("_deg") || name.ends_with("_deg_s") || name.ends_with("_m") ||
        name.ends_with("_m_s")) {
      throw_bad_input(fmt::format("'{}' is in another unit", clipped(name)), file,
                      "positions of movements are in rad and velocities in rad/s");
    }
    throw_bad_input(fmt::format("there is no column '{}'", clipped(name)), file,
                    did_you_mean(name, known_columns()));
  }
  for (const char* needed : {"kind", "velocity_rad_s", "from_rad", "to_rad"}) {
    if (std::ranges::count(cells.header, needed) == 0) {
      throw_bad_input(fmt::format("there is no column '{}'", needed), file,
                      "columns as in next_movements.csv: kind, velocity_rad_s, from_rad, to_rad");
    }
  }
}

constexpr double kLargest = 1e6;

void read_constant(const MovementLine& line, PlannedMovement& movement) {
  if (movement.velocity == 0 || (movement.to - movement.from) * movement.velocity <= 0) {
    throw_bad_input(fmt::format("from {:g} to {:g} is not the way of a velocity of {:g}",
                                movement.from, movement.to, movement.velocity),
                    line.place(), "give the velocity the sign of to - from, and a way");
  }
  movement.duration = (movement.to - movement.from) / movement.velocity;
}

void read_tones(const MovementLine& line, PlannedMovement& movement) {
  movement.duration = line.number("duration_s", 1e-3, kLargest);
  movement.tones = {
      {{line.number("tone1_rad", 0, kLargest), line.number("tone1_Hz", 0, 1e3)},
       {line.number_or("tone2_rad", 0, 0, kLargest), line.number_or("tone2_Hz", 0, 0, 1e3)}}};
  const double reach = movement.tones[0].amplitude + movement.tones[1].amplitude;
  if (reach > 0.5 * std::abs(movement.to - movement.from) * (1 + 1e-6)) {
    throw_bad_input(fmt::format("the tones reach {:g} to either side, from and to leave {:g}",
                                reach, 0.5 * std::abs(movement.to - movement.from)),
                    line.place(), "make the amplitudes smaller or the range wider");
  }
}

PlannedMovement read_movement(const MovementLine& line) {
  PlannedMovement movement;
  movement.kind = line.text("kind");
  movement.velocity = line.number("velocity_rad_s", -kLargest, kLargest);
  movement.from = line.number("from_rad", -kLargest, kLargest);
  movement.to = line.number("to_rad", -kLargest, kLargest);
  movement.load_factor = line.number_or("load_factor", 1, -kLargest, kLargest);
  movement.rest = line.number_or("rest_s", 0, 0, kLargest);
  movement.other_velocity = line.number_or("other_velocity_rad_s", 0, 0, kLargest);
  if (movement.kind == "constant") {
    read_constant(line, movement);
  } else if (movement.is_two_tone()) {
    read_tones(line, movement);
  } else {
    throw_bad_input(fmt::format("there is no kind '{}' of movement", clipped(movement.kind)),
                    line.place(), did_you_mean(movement.kind, {"constant", "two_tone"}));
  }
  return movement;
}

}  // namespace

PlannedMovement constant_movement(double velocity, double low, double high, double load_factor) {
  PlannedMovement movement;
  movement.kind = "constant";
  movement.velocity = velocity;
  movement.from = velocity > 0 ? low : high;
  movement.to = velocity > 0 ? high : low;
  movement.load_factor = load_factor;
  movement.duration = std::abs((high - low) / velocity);
  return movement;
}

PlannedMovement two_tone_movement(double peak, double low, double high, double load_factor) {
  PlannedMovement movement;
  movement.kind = "two_tone";
  movement.velocity = peak;
  movement.from = low;
  movement.to = high;
  movement.load_factor = load_factor;
  const double half = 0.5 * (high - low);
  const double frequency = peak / half / (2 * std::numbers::pi);
  movement.tones = {
      {{0.6 * half, frequency}, {0.4 / kTwoToneRatio * half, kTwoToneRatio * frequency}}};
  movement.duration = kPeriods / frequency;
  return movement;
}

std::string unit_suffix(std::string_view unit) {
  std::string text = unit.empty() ? "" : "_" + std::string(unit);
  std::ranges::replace(text, '/', '_');
  std::erase(text, '^');
  return text;
}

std::string movements_text(const std::vector<PlannedMovement>& movements,
                           std::string_view position_unit, std::string_view velocity_unit,
                           const std::vector<std::string>& extra) {
  const std::string q = unit_suffix(position_unit);
  const std::string v = unit_suffix(velocity_unit);
  const bool rests = std::ranges::any_of(movements, [](const auto& m) { return m.rest != 0; });
  const bool others =
      std::ranges::any_of(movements, [](const auto& m) { return m.other_velocity != 0; });
  std::string text = fmt::format(
      "order,kind,velocity{1},from{0},to{0},load_factor,duration_s,tone1{0},tone1_Hz,tone2{0},"
      "tone2_Hz{2}{3}{4}{5}\n",
      q, v, rests ? ",rest_s" : "", others ? ",other_velocity" + v : "", extra.empty() ? "" : ",",
      extra.empty() ? "" : extra.front());
  for (std::size_t i = 0; i < movements.size(); ++i) {
    const PlannedMovement& m = movements[i];
    text +=
        fmt::format("{},{},{},{},{},{},{}", i + 1, m.kind, m.velocity, number_or_nothing(m.from),
                    number_or_nothing(m.to), m.load_factor, number_or_nothing(m.duration));
    for (const Tone& tone : m.tones) {
      text += m.is_two_tone() ? fmt::format(",{},{}", tone.amplitude, tone.frequency) : ",,";
    }
    if (rests) text += fmt::format(",{}", m.rest);
    if (others) text += fmt::format(",{}", m.other_velocity);
    if (!extra.empty()) text += "," + extra[i + 1];
    text += "\n";
  }
  return text;
}

std::vector<PlannedMovement> read_movements(std::string_view text, std::string_view file) {
  const CsvCells cells = split_csv(text, file);
  check_header(cells, file);
  std::vector<PlannedMovement> movements;
  for (const CsvLine& line : cells.lines) {
    if (!line.blank()) movements.push_back(read_movement(MovementLine(cells, line, file)));
  }
  if (movements.empty()) throw_bad_input("there is no movement in it", file, "a line a movement");
  return movements;
}

}  // namespace tribench
