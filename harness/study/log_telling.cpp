// SPDX-License-Identifier: MIT
#include "harness/study/log_telling.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string_view>

#include "foundation/elementary.hpp"
#include "problems/joint_simulation/causes.hpp"

namespace tribench {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kScaleStep_m = 1e-6;  // of a linear encoder at 12 bits; finer with more

struct TellingUnit {
  std::string_view symbol;  // in --roles
  double per_si;            // of the unit in one of SI, at the joint
  bool at_motor = false;
};

constexpr std::array<TellingUnit, 5> kAngles = {{{"rad", 1},
                                                 {"deg", 360 / kTurn},
                                                 {"mrad", 1e3},
                                                 {"rev", 1 / kTurn},
                                                 {"deg", 360 / kTurn, true}}};
constexpr std::array<TellingUnit, 4> kSpeeds = {
    {{"rad/s", 1}, {"deg/s", 360 / kTurn}, {"rpm", 60 / kTurn}, {"rpm", 60 / kTurn, true}}};
constexpr std::array<TellingUnit, 2> kLengths = {{{"m", 1}, {"mm", 1e3}}};
constexpr std::array<TellingUnit, 2> kLinearSpeeds = {{{"m/s", 1}, {"mm/s", 1e3}}};
constexpr std::array<TellingUnit, 4> kTimes = {{{"s", 1}, {"ms", 1e3}, {"us", 1e6}, {"ns", 1e9}}};

template <std::size_t N>
TellingUnit draw(const std::array<TellingUnit, N>& units, bool motor, RandomStream& random) {
  for (;;) {
    const TellingUnit unit = units[random.below(N)];
    if (motor || !unit.at_motor) return unit;
  }
}

std::string_view draw(std::span<const std::string_view> names, RandomStream& random) {
  return names[random.below(names.size())];
}

double counts_of(int bits) { return static_cast<double>(1ULL << bits); }

// A column of the file: numbers as they are written.
struct LogColumn {
  std::string name;  // as a header that tells names it
  std::string role;
  TellingUnit unit;
  int digits = 6;
  std::vector<double> values;
};

// An encoder's counts as the position they stand for.
std::vector<double> encoded(const std::vector<double>& position, double count) {
  std::vector<double> out;
  for (const double q : position) out.push_back(std::floor(q / count) * count);
  return out;
}

// A controller's velocity: differences of the position through a filter of first order.
std::vector<double> filtered_velocity(const std::vector<double>& time,
                                      const std::vector<double>& position, double filter_s) {
  std::vector<double> out = {0};
  for (std::size_t i = 1; i < time.size(); ++i) {
    const double dt = time[i] - time[i - 1];
    const double share = -elementary::expm1(-dt / filter_s);
    out.push_back(out.back() + share * ((position[i] - position[i - 1]) / dt - out.back()));
  }
  return out;
}

struct Layout {
  char separator = ',';
  bool decimal_comma = false;
  bool comment = false;
  bool units_row = false;
  int brackets = 0;  // "q [deg]", "q (deg)", "q_deg"
};

Layout draw_layout(RandomStream& random) {
  Layout layout;
  constexpr std::string_view kSeparators = ",,;\t";
  layout.separator = kSeparators[random.below(kSeparators.size())];
  layout.decimal_comma = layout.separator != ',' && random.chance(0.4);
  layout.comment = random.chance(0.3);
  layout.units_row = random.chance(0.2);
  layout.brackets = static_cast<int>(random.below(3));
  return layout;
}

std::string header_of(const LogColumn& column, const Layout& layout, LogKnowledge knowledge,
                      std::size_t number) {
  if (knowledge == LogKnowledge::told) return fmt::format("ch{}", number + 1);
  if (layout.units_row) return column.name;
  std::string unit(column.unit.symbol);
  if (layout.brackets == 0) return fmt::format("{} [{}]", column.name, unit);
  if (layout.brackets == 1) return fmt::format("{} ({})", column.name, unit);
  std::ranges::replace(unit, '/', '_');
  std::erase(unit, ' ');
  return column.name + "_" + unit;
}

// A row of the file: the sample whose stamp it bears and the one whose message it holds.
struct BusRow {
  std::size_t stamp;
  std::size_t message;
};

// The first column is the stamp.
void append_row(std::string& text, const std::vector<LogColumn>& columns, const BusRow& row,
                const Layout& layout) {
  for (std::size_t j = 0; j < columns.size(); ++j) {
    const double value = columns[j].values[j == 0 ? row.stamp : row.message];
    std::string cell = fmt::format("{:.{}f}", value, columns[j].digits);
    if (layout.decimal_comma) std::ranges::replace(cell, '.', ',');
    if (j > 0) text += layout.separator;
    text += cell;
  }
  text += '\n';
}

// Stretches are lost, or hold what was there before.
std::vector<BusRow> rows_on_the_bus(std::size_t samples, RandomStream& random) {
  enum { whole, gaps, repeats };
  const std::uint64_t kind = random.below(4) % 3;
  std::vector<BusRow> rows;
  std::size_t left = 0;  // rows of the stretch
  std::size_t held = 0;
  for (std::size_t i = 0; i < samples; ++i) {
    if (left == 0 && kind != whole && random.chance(0.0005)) {
      left = 8 + random.below(60);
      held = i;
    }
    if (left > 0) {
      --left;
      if (kind == repeats) rows.push_back({i, held});
      continue;
    }
    rows.push_back({i, i});
  }
  return rows;
}

class Teller {
 public:
  Teller(const simulation::ControlledRun& run, LogKnowledge knowledge, RandomStream random,
         std::optional<int> encoder_bits)
      : run_(run),
        knowledge_(knowledge),
        random_(random),
        encoder_bits_(encoder_bits),
        linear_(run.data.find(Role::position)->unit == "m") {}

  ToldLog tell() {
    add_time();
    add_position();
    add_effort();
    if (random_.chance(0.25)) add_gravity();
    write();
    say();
    out_.summary = fmt::format("{}", fmt::join(words_, ", "));
    return std::move(out_);
  }

 private:
  bool told() const { return knowledge_ == LogKnowledge::told; }

  void add(LogColumn column) {
    words_.push_back(fmt::format("{} [{}{}]", column.role, column.unit.symbol,
                                 column.unit.at_motor ? "@motor" : ""));
    columns_.push_back(std::move(column));
  }

  void add_time() {
    constexpr std::array<std::string_view, 4> kNames = {"time", "t", "stamp", "timestamp"};
    const TellingUnit unit = draw(kTimes, false, random_);
    const bool epoch = unit.symbol == "ns" || random_.chance(0.2);
    const std::vector<double>& time = run_.data.find(Role::time)->values;
    const double step = time[1] - time[0];
    const double jitter = random_.chance(0.5) ? 0.05 * step : 0;
    LogColumn column{std::string(draw(kNames, random_)),
                     "time",
                     unit,
                     unit.per_si > 1e5 ? 0
                     : unit.per_si > 1 ? 3
                                       : 6,
                     {}};
    for (const double t : time) {
      // Whole microseconds: beside an epoch a double holds no more.
      const double stamp = t + jitter * random_.uniform(-1, 1) + (epoch ? 1.75e9 : 0);
      column.values.push_back(std::round(stamp * 1e6) * 1e-6 * unit.per_si);
    }
    add(std::move(column));
  }

  void add_position() {
    constexpr std::array<std::string_view, 4> kNames = {"q", "pos", "position", "joint_position"};
    const int bits = encoder_bits_.value_or(12 + 2 * static_cast<int>(random_.below(5)));
    const double turn = linear_ ? kScaleStep_m * 4096 : kTurn;
    // On the motor's side a turn of the joint has a hundred times the counts.
    const bool on_motor = !linear_ && told() && !encoder_bits_ && random_.chance(0.25);
    const double count = turn / counts_of(bits) / (on_motor ? simulation::kGearRatio : 1);
    words_.push_back(fmt::format("2^{} counts{}", bits, on_motor ? " on the motor" : ""));
    const std::vector<double> position = encoded(run_.data.find(Role::position)->values, count);
    TellingUnit unit = linear_ ? draw(kLengths, false, random_) : draw(kAngles, told(), random_);
    if (told() && !linear_ && random_.chance(0.3)) {
      unit = {"counts", counts_of(bits) / kTurn, on_motor};
      out_.known.drive.counts_per_turn = counts_of(bits);
    }
    const double factor = factor_of(unit);
    LogColumn column{
        std::string(draw(kNames, random_)),
        "position",
        unit,
        std::max(0, static_cast<int>(std::ceil(-elementary::log10(count * factor))) + 2),
        {}};
    for (const double q : position) column.values.push_back(q * factor);
    add(std::move(column));
    if (!encoder_bits_ && random_.chance(0.5)) add_velocity(position);
  }

  void add_velocity(const std::vector<double>& position) {
    constexpr std::array<std::string_view, 4> kNames = {"dq", "vel", "velocity", "qd"};
    const TellingUnit unit =
        linear_ ? draw(kLinearSpeeds, false, random_) : draw(kSpeeds, told(), random_);
    const double factor = factor_of(unit);
    LogColumn column{std::string(draw(kNames, random_)), "velocity", unit, 5, {}};
    const double filter_s = random_.uniform(0.003, 0.02);
    for (const double v :
         filtered_velocity(run_.data.find(Role::time)->values, position, filter_s)) {
      column.values.push_back(v * factor);
    }
    add(std::move(column));
  }

  void add_effort() {
    constexpr std::array<std::string_view, 3> kTorques = {"torque", "tau", "motor_torque"};
    constexpr std::array<std::string_view, 3> kCurrents = {"current", "motor_current", "cur"};
    const std::vector<double>& torque = run_.data.find(Role::motor_torque)->values;
    const bool thousand = random_.chance(0.4);
    LogColumn column;
    double factor = thousand ? 1e3 : 1;
    if (random_.chance(0.6)) {
      const double constant = random_.uniform(4, 14) * (linear_ ? 10 : 1);  // at the joint
      column = {std::string(draw(kCurrents, random_)),
                "motor_current",
                {thousand ? "mA" : "A", 0},
                thousand ? 1 : 4,
                {}};
      factor /= constant;
      out_.torque_scale = constant;
      if (told() && !linear_) {
        const bool at_motor = random_.chance(0.4);
        out_.known.torque_constant =
            TorqueConstant{at_motor ? constant / simulation::kGearRatio : constant, at_motor};
        out_.torque_scale = 1;
      }
    } else if (linear_) {
      column = {"force", "motor_torque", {"N", 0}, 3, {}};
      factor = 1;
    } else {
      column = {std::string(draw(kTorques, random_)),
                "motor_torque",
                {thousand ? "mN m" : "N m", 0},
                thousand ? 0 : 3,
                {}};
    }
    for (const double tau : torque) column.values.push_back(tau * factor);
    current_ = column.role == "motor_current";
    add(std::move(column));
  }

  // A model's gravity beside a current would need its constant; beside a constant it is as it is.
  void add_gravity() {
    const std::vector<double>& gravity = run_.data.find(Role::gravity_torque)->values;
    if (linear_ || (current_ && !out_.known.torque_constant)) return;
    add({"gravity_torque", "gravity_torque", {"N m", 1}, 4, gravity});
  }

  double factor_of(const TellingUnit& unit) const {
    return unit.per_si * (unit.at_motor ? simulation::kGearRatio : 1);
  }

  void write() {
    const Layout layout = draw_layout(random_);
    std::string& text = out_.text;
    if (layout.comment) text += "# recorded by the controller\n";
    for (const bool units : {false, true}) {
      if (units && (told() || !layout.units_row)) continue;
      for (std::size_t j = 0; j < columns_.size(); ++j) {
        if (j > 0) text += layout.separator;
        text += units ? std::string(columns_[j].unit.symbol)
                      : header_of(columns_[j], layout, knowledge_, j);
      }
      text += '\n';
    }
    for (const BusRow& row : rows_on_the_bus(columns_[0].values.size(), random_)) {
      append_row(text, columns_, row, layout);
    }
  }

  // What the engineer knows, as options.
  void say() {
    if (!told()) return;
    std::vector<std::string> roles;
    for (std::size_t j = 0; j < columns_.size(); ++j) {
      const LogColumn& column = columns_[j];
      roles.push_back(fmt::format("ch{}={}[{}{}]", j + 1, column.role, column.unit.symbol,
                                  column.unit.at_motor ? "@motor" : ""));
    }
    const std::string text = fmt::format("{}", fmt::join(roles, ","));
    out_.known.roles = parse_roles(text, "--roles");
    out_.options = {"--roles", text};
    if (!linear_) {
      out_.known.drive.gear_ratio = simulation::kGearRatio;
      out_.options.insert(out_.options.end(),
                          {"--gear-ratio", fmt::format("{}", simulation::kGearRatio)});
    }
    if (out_.known.drive.counts_per_turn) {
      out_.options.insert(
          out_.options.end(),
          {"--counts-per-turn", fmt::format("{}", *out_.known.drive.counts_per_turn)});
    }
    if (const auto& constant = out_.known.torque_constant) {
      out_.options.insert(out_.options.end(),
                          {"--torque-constant", fmt::format("{}{}", constant->value,
                                                            constant->at_motor ? "@motor" : "")});
    }
  }

  const simulation::ControlledRun& run_;
  LogKnowledge knowledge_;
  RandomStream random_;
  std::optional<int> encoder_bits_;
  bool linear_;
  bool current_ = false;
  std::vector<LogColumn> columns_;
  std::vector<std::string> words_;
  ToldLog out_;
};

}  // namespace

ToldLog tell_log(const simulation::ControlledRun& run, LogKnowledge knowledge, RandomStream random,
                 std::optional<int> encoder_bits) {
  return Teller(run, knowledge, random, encoder_bits).tell();
}

}  // namespace tribench
