// SPDX-License-Identifier: MIT
#include "problems/preparation/motion_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "foundation/elementary.hpp"
#include "foundation/error.hpp"
#include "problems/preparation/segments.hpp"
#include "problems/reading/units.hpp"

namespace tribench {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

constexpr double kGood = 0.15;         // of the slope's logarithm: the same motion
constexpr double kAsNear = 0.02;       // two factors are one
constexpr double kTellsMotion = 0.9;   // correlation from which the slope says something
constexpr double kTellsNothing = 0.5;  // correlation of a rate that is another quantity's
constexpr double kLongWindow = 0.8;    // s: what noise does is small beside what motion does
// From the short window to the long one, eight times as long, noise grows by 1 (of a quantity) or
// by the root of 8 (of a rate's integral), motion by up to 8.
constexpr double kGrowsByMotion = 2;
constexpr double kGrowsAsIntegral = 4;
constexpr double kMostTurns = 2;        // of a joint, either way together
constexpr double kLongestStep = 0.5;    // s
constexpr double kShortestStep = 1e-5;  // s

const ColumnReading* reading_of(const DataFile& file, Role role) {
  const auto found = std::ranges::find(file.readings, role, &ColumnReading::role);
  return found == file.readings.end() ? nullptr : &*found;
}

// A factor that a wrong unit makes, and the mend for the column it belongs to.
struct Suspect {
  double factor;  // of (change of the quantity) / (integral of its rate)
  Role role;
  std::string unit;    // that it has
  std::string remark;  // in place of a unit to say
};

// What the factor becomes where a column's unit is `times` as large as the one it was read in.
double factor_of(Role role, double times) { return role == Role::position ? 1 / times : times; }

// Every other usual unit of the column, on either side of the gear.
void add_units(std::vector<Suspect>& list, const DataFile& file, Role role,
               std::initializer_list<const char*> units, std::optional<double> gear_ratio) {
  const ColumnReading* reading = reading_of(file, role);
  if (reading == nullptr || reading->factor == 0) return;
  const double read_as = std::abs(reading->factor);
  for (const char* symbol : units) {
    const Unit& unit = *find_unit(symbol);
    if (unit.si != reading->si) continue;
    const auto add = [&](double size, const std::string& text) {
      if (text != reading->unit) list.push_back({factor_of(role, size / read_as), role, text, ""});
    };
    add(unit.factor, symbol);
    if (gear_ratio && unit.si.starts_with("rad")) {
      add(unit.factor / *gear_ratio, fmt::format("{}@motor", symbol));
    }
  }
}

// The likelier one first, of those that make the same factor.
std::vector<Suspect> suspects(const DataFile& file, std::optional<double> gear_ratio) {
  std::vector<Suspect> list;
  add_units(list, file, Role::time, {"s", "ms", "us", "ns", "min", "h", "d"}, gear_ratio);
  add_units(list, file, Role::position, {"rad", "deg", "rev", "m", "mm", "cm"}, gear_ratio);
  add_units(list, file, Role::velocity,
            {"rad/s", "deg/s", "rev/s", "rpm", "m/s", "mm/s", "cm/s", "m/min", "mm/min"},
            gear_ratio);
  const ColumnReading* position = reading_of(file, Role::position);
  if (position != nullptr && position->unit.starts_with("counts")) {
    list.push_back({4, Role::position, "", "counts, after quadrature"});
    list.push_back({0.25, Role::position, "", "counts, before quadrature"});
  }
  return list;
}

std::vector<Suspect> suspects_of_acceleration(const DataFile& file,
                                              std::optional<double> gear_ratio) {
  std::vector<Suspect> list;
  add_units(list, file, Role::acceleration, {"rad/s^2", "deg/s^2", "m/s^2", "mm/s^2"}, gear_ratio);
  return list;
}

// Where another column's unit, which was not its plain one, makes the same factor, both are said.
std::string mend_for(const DataFile& file, const std::vector<Suspect>& list,
                     const Suspect& suspect) {
  if (!suspect.remark.empty()) {
    return fmt::format("check the {}: {}", role_name(suspect.role), suspect.remark);
  }
  const auto role = [&](const Suspect& one) {
    return fmt::format("'{}={}[{}]'", reading_of(file, one.role)->column, role_name(one.role),
                       one.unit);
  };
  std::string mend = "say --roles " + role(suspect);
  for (const Suspect& other : list) {
    const ColumnReading* reading = reading_of(file, other.role);
    if (other.role == suspect.role || reading->unit_assumed || other.unit != reading->si) continue;
    if (std::abs(elementary::log(other.factor / suspect.factor)) > kAsNear) continue;
    mend += " or " + role(other);
  }
  return mend;
}

// The factor nearest to the slope; of two as near the one whose unit was only assumed.
const Suspect* find_suspect(const DataFile& file, const std::vector<Suspect>& list, double slope) {
  const Suspect* found = nullptr;
  double nearest = kSameFactor;
  bool assumed = false;
  for (const Suspect& one : list) {
    const ColumnReading* reading = reading_of(file, one.role);
    const double away = std::abs(elementary::log(std::abs(slope) / one.factor));
    const bool better = reading->unit_assumed && !assumed
                            ? away < nearest + kAsNear
                            : away < nearest - kAsNear || (found == nullptr && away < nearest);
    const bool nearer = reading->unit_assumed == assumed && away < nearest;
    if (away > kSameFactor || !(better || nearer)) continue;
    found = &one;
    nearest = away;
    assumed = reading->unit_assumed;
  }
  return found;
}

// The velocity changes as the position says, and the position not as the velocity. Of one sine each
// is the other's rate but for a factor and a sign: there the factor has to be 1.
void check_not_exchanged(const DataFile& file, const Channel& q, const Channel& v,
                         const MotionMatch& match, const MotionMatch& exchanged) {
  const auto is_one = [](double slope) {
    return slope > 0 && std::abs(elementary::log(slope)) < kGood;
  };
  const bool is_related = std::abs(match.agreement) >= kTellsMotion;
  if (is_related && (match.slope > 0 || is_one(-match.slope) || !is_one(exchanged.slope))) return;
  if (exchanged.agreement < kTellsMotion) return;
  throw_bad_input(
      fmt::format("'{}' changes as '{}' says: the two are exchanged", v.name, q.name),
      file.data.name,
      fmt::format("give --roles '{}=position,{}=velocity' (with their units)", v.name, q.name));
}

void check_match(const DataFile& file, const MotionMatch& match, std::optional<double> gear_ratio) {
  if (std::abs(match.agreement) < kTellsMotion) return;
  const std::string& velocity = reading_of(file, Role::velocity)->column;
  const std::string& position = reading_of(file, Role::position)->column;
  if (match.slope > 0 && std::abs(elementary::log(match.slope)) < kGood) return;
  const std::string what = fmt::format("'{}' changes {:.4g} times as fast as '{}' says", position,
                                       match.slope, velocity);
  if (match.slope < 0 && std::abs(elementary::log(-match.slope)) < kGood) {
    const std::string& unit = reading_of(file, Role::velocity)->unit;
    throw_bad_input(what, file.data.name,
                    fmt::format("one of the two has its sign turned: turn it with --roles "
                                "'{0}=velocity[-1 {1}]' (or the position's and, where the torque "
                                "goes with '{0}', {2} --flip-sign)",
                                velocity, unit.empty() ? "rad/s" : unit,
                                file.data.torques_flipped ? "without" : "with"));
  }
  const std::vector<Suspect> list = suspects(file, gear_ratio);
  const Suspect* suspect = find_suspect(file, list, match.slope);
  throw_bad_input(what, file.data.name,
                  suspect != nullptr ? mend_for(file, list, *suspect)
                                     : "check the units of position, velocity and time (--roles "
                                       "COLUMN=ROLE[UNIT]), --counts-per-turn and --gear-ratio");
}

// A rate that says nothing of how the quantity changes, though both move: another joint's, or
// shifted in time.
void check_related(const DataFile& file, const Channel& quantity, const Channel& rate,
                   const MotionMatch& match, const MotionMatch& longer) {
  const bool both_move = longer.change > kGrowsByMotion * match.change &&
                         longer.integral > kGrowsAsIntegral * match.integral;
  const double agreement = std::max(std::abs(match.agreement), std::abs(longer.agreement));
  if (!both_move || agreement >= kTellsNothing) return;
  throw_bad_input(
      fmt::format("'{}' does not tell how '{}' changes (correlation {:.2f})", rate.name,
                  quantity.name, longer.agreement),
      file.data.name,
      fmt::format("are both of the same joint and time? Without '{0}' it is derived: --roles "
                  "'{0}=none'",
                  rate.name));
}

// An acceleration may be filtered: only a unit or a sign is believed to be wrong.
void check_acceleration(const DataFile& file, const MotionMatch& match,
                        std::optional<double> gear_ratio) {
  const ColumnReading* acceleration = reading_of(file, Role::acceleration);
  const ColumnReading* velocity = reading_of(file, Role::velocity);
  if (acceleration == nullptr || velocity == nullptr) return;
  if (std::abs(match.agreement) < kTellsMotion) return;
  const std::vector<Suspect> list = suspects_of_acceleration(file, gear_ratio);
  const Suspect* suspect = find_suspect(file, list, match.slope);
  if (match.slope > 0 && suspect == nullptr) return;
  throw_bad_input(
      fmt::format("'{}' changes {:.4g} times as fast as '{}' says", velocity->column, match.slope,
                  acceleration->column),
      file.data.name,
      match.slope > 0
          ? mend_for(file, list, *suspect)
          : fmt::format("its sign is turned, or it is another joint's; without it it is "
                        "derived: --roles '{}=none'",
                        acceleration->column));
}

// How many turns a joint's position ranges over; 0 where it is none, or the motor's by its name.
double turns_of(const DataFile& file) {
  const ColumnReading* position = reading_of(file, Role::position);
  const Channel* q = file.data.find(Role::position);
  if (position == nullptr || q == nullptr || q->unit != "rad") return 0;
  if (position->unit.ends_with("@motor")) return 0;
  const auto [low, high] = std::ranges::minmax(q->values);
  return (high - low) / kTurn;
}

// A joint that turns over and over, in a unit that was only assumed or on a side of the gear that
// nobody named: counts and, beside a gear ratio, turns may well be the motor's.
void check_turns(const DataFile& file, std::optional<double> gear_ratio) {
  const double turns = turns_of(file);
  if (turns <= kMostTurns) return;
  const ColumnReading* position = reading_of(file, Role::position);
  const bool may_be_motor = position->unit_from != "--roles" &&
                            (position->unit == "counts" || (gear_ratio && !position->unit_assumed));
  if (may_be_motor) {
    throw_bad_input(
        fmt::format("'{}' ranges over {:.3g} turns: nothing says on which side of the gear",
                    position->column, turns),
        file.data.name,
        fmt::format("say --roles '{0}=position[{1}@motor]' with --gear-ratio, or "
                    "'{0}=position[{1}]' if it is the joint",
                    position->column, position->unit));
  }
  if (!position->unit_assumed) return;
  throw_bad_input(
      fmt::format("'{}' ranges over {:.4g} rad, {:.3g} turns: its unit was only assumed",
                  position->column, turns * kTurn, turns),
      file.data.name,
      fmt::format("say it: --roles '{0}=position[deg]', or '{0}=position[rad]' if it "
                  "is so",
                  position->column));
}

// In which rows are as far apart as those of a recording are. Days and hours: spreadsheets.
std::string_view likely_unit_of(double step) {
  constexpr double kClosest = 1e-4;  // s
  constexpr double kFarthest = 0.02;
  constexpr std::pair<double, std::string_view> kUnits[] = {
      {1e-3, "ms"}, {1e-6, "us"}, {1e-9, "ns"}, {86400, "d"}, {3600, "h"}};
  for (const auto& [factor, unit] : kUnits) {
    if (step * factor >= kClosest && step * factor <= kFarthest) return unit;
  }
  return "ms";
}

// What was taken for SI because its name's source always uses SI, and cannot be.
void check_assumed_time(const DataFile& file) {
  const ColumnReading* time = reading_of(file, Role::time);
  const Channel* t = file.data.find(Role::time);
  if (time == nullptr || !time->unit_assumed || t == nullptr) return;
  const double step = median_step(t->values, file.data.movement);
  const bool derives = file.data.find(Role::velocity) == nullptr;
  if (derives && step > 0 && (step > kLongestStep || step < kShortestStep)) {
    throw_bad_input(
        fmt::format("'{}' steps by {:.4g} s: its unit was only assumed", time->column, step),
        file.data.name,
        fmt::format("say it: --roles '{0}=time[{1}]', or '{0}=time[s]' if it is so", time->column,
                    likely_unit_of(step)));
  }
}

// A slide's position beside its motor's speed, or a joint's beside a slide's.
void check_same_side(const Channel& q, const Channel& v, double slope, const std::string& file) {
  const bool slides = q.unit == "m";
  const bool turns = q.unit == "rad";
  if (!(slides && v.unit == "rad/s") && !(turns && v.unit == "m/s")) return;
  const double lead = kTurn * std::abs(slides ? slope : 1 / slope);
  throw_bad_input(
      fmt::format("'{}' is in {} and '{}' in {}: of the two sides of a screw or belt ({:.4g} mm a "
                  "turn)",
                  q.name, q.unit, v.name, v.unit, 1e3 * lead),
      file, fmt::format("leave it out and the velocity is derived: --roles '{}=none'", v.name));
}

// A column of the velocity, or of the position, that nobody fills.
void check_not_dead(const DataFile& file, const Channel& q, const Channel& v) {
  const auto is_zero = [](double value) { return value == 0; };
  const auto [low, high] = std::ranges::minmax(q.values);
  const bool is_still = std::ranges::all_of(v.values, is_zero);
  if (low == high && !is_still) {
    throw_bad_input(fmt::format("'{}' is {} in every row while '{}' moves", q.name, low, v.name),
                    file.data.name,
                    fmt::format("name the column that holds the position, or leave this one out: "
                                "--roles '{}=none'",
                                q.name));
  }
  if (low == high || !is_still) return;
  throw_bad_input(
      fmt::format("'{}' is 0 in every row while '{}' moves", v.name, q.name), file.data.name,
      fmt::format("leave it out and the velocity is derived: --roles '{}=none'", v.name));
}

}  // namespace

MotionMatch match_motion(std::span<const double> time, std::span<const double> quantity,
                         std::span<const double> rate, std::span<const RowRange> pieces,
                         double window) {
  double qq = 0;
  double vv = 0;
  double qv = 0;
  std::size_t count = 0;
  // An encoder's count is small beside what changes in a tenth of a second or so.
  for (const RowRange& piece : pieces) {
    const double span = time[piece.end - 1] - time[piece.begin];
    const auto rows = static_cast<double>(piece.end - piece.begin);
    const auto stride =
        std::clamp<std::size_t>(static_cast<std::size_t>(span > 0 ? window * rows / span : 1), 1,
                                std::max<std::size_t>((piece.end - piece.begin) / 8, 1));
    for (std::size_t i = piece.begin; i + stride < piece.end; i += stride) {
      double integral = 0;
      for (std::size_t k = i; k < i + stride; ++k) {
        integral += 0.5 * (rate[k] + rate[k + 1]) * (time[k + 1] - time[k]);
      }
      const double change = quantity[i + stride] - quantity[i];
      qq += change * change;
      vv += integral * integral;
      qv += change * integral;
      ++count;
    }
  }
  if (qq <= 0 || vv <= 0) return {};
  const auto n = static_cast<double>(count);
  // Of the two slopes the one that noise in neither pulls to 0: their geometric mean.
  return {std::copysign(std::sqrt(qq / vv), qv), qv / std::sqrt(qq * vv), std::sqrt(qq / n),
          std::sqrt(vv / n)};
}

void check_motion(const DataFile& file, std::optional<double> gear_ratio) {
  const Channel* q = file.data.find(Role::position);
  const Channel* v = file.data.find(Role::velocity);
  const Channel* a = file.data.find(Role::acceleration);
  const Channel* t = file.data.find(Role::time);
  std::vector<RowRange> pieces;
  if (t != nullptr) pieces = pieces_of(t->values, file.data.movement, {});
  if (q != nullptr && v != nullptr && t != nullptr) {
    check_not_dead(file, *q, *v);
    const MotionMatch match = match_motion(t->values, q->values, v->values, pieces);
    check_same_side(*q, *v, match.slope, file.data.name);
    check_not_exchanged(file, *q, *v, match, match_motion(t->values, v->values, q->values, pieces));
    check_match(file, match, gear_ratio);
    check_related(file, *q, *v, match,
                  match_motion(t->values, q->values, v->values, pieces, kLongWindow));
  }
  if (v != nullptr && a != nullptr && t != nullptr) {
    const MotionMatch match = match_motion(t->values, v->values, a->values, pieces);
    check_acceleration(file, match, gear_ratio);
    check_related(file, *v, *a, match,
                  match_motion(t->values, v->values, a->values, pieces, kLongWindow));
  }
  check_turns(file, gear_ratio);
  check_assumed_time(file);
}

std::optional<std::string> remark_on_turns(const DataFile& file) {
  const double turns = turns_of(file);
  if (turns <= kMostTurns) return std::nullopt;
  const ColumnReading& position = *reading_of(file, Role::position);
  if (position.unit_from == "--roles") return std::nullopt;
  // The same figures in degrees.
  const double turns_if_degrees = turns * std::numbers::pi / 180;
  const bool may_be_degrees = position.unit == "rad" && turns_if_degrees <= kMostTurns;
  return fmt::format(
      "'{0}' ranges over {1:.3g} turns, taken for the joint's: if they are the motor's, say "
      "--roles '{0}=position[{2}@motor]' with --gear-ratio{3} (and so of the velocity)",
      position.column, turns, position.unit,
      may_be_degrees
          ? fmt::format("; if its figures are degrees, '{}=position[deg]'", position.column)
          : "");
}

std::optional<double> delay_of(std::span<const double> time,
                               std::span<const double> velocity_of_position,
                               std::span<const double> velocity, std::span<const RowRange> pieces) {
  constexpr double kLongest = 0.1;  // s
  std::vector<double> errors;
  double step = 0;
  std::size_t most = 0;
  for (const RowRange& piece : pieces) {
    if (piece.end - piece.begin < 50) continue;
    const double one = (time[piece.end - 1] - time[piece.begin]) /
                       static_cast<double>(piece.end - piece.begin - 1);
    if (step == 0) {
      step = one;
      most = std::min<std::size_t>(static_cast<std::size_t>(kLongest / std::max(one, 1e-6)), 100);
      errors.assign(2 * most + 1, 0.0);
    }
    const std::size_t stride = std::max<std::size_t>(1, (piece.end - piece.begin) / 20'000);
    for (std::size_t i = piece.begin + most; i + most < piece.end; i += stride) {
      for (std::size_t k = 0; k <= 2 * most; ++k) {
        const double e = velocity[i + k - most] - velocity_of_position[i];
        errors[k] += e * e;
      }
    }
  }
  if (errors.size() < 3) return {};
  const auto best = static_cast<std::size_t>(std::ranges::min_element(errors) - errors.begin());
  if (best == 0 || best + 1 == errors.size()) return {};
  // Where the shift hardly matters there is nothing to be told.
  if (errors[best] > 0.8 * std::max(errors.front(), errors.back())) return {};
  const double bend = errors[best - 1] - 2 * errors[best] + errors[best + 1];
  const double part = bend > 0 ? 0.5 * (errors[best - 1] - errors[best + 1]) / bend : 0;
  return step * (static_cast<double>(best) - static_cast<double>(most) + part);
}

}  // namespace tribench
