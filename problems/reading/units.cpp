// SPDX-License-Identifier: MIT
#include "problems/reading/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "foundation/suggestion.hpp"
#include "foundation/text.hpp"

namespace tribench {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kDegree = std::numbers::pi / 180;

using enum Dimension;

// Spellings are compared after `plain_unit`: without blanks, dots, stars and carets.
struct Known {
  Unit unit;
  std::string_view spellings;  // apart by '|', the first is the usual one
};

constexpr std::array kKnown = {
    Known{{"rad", "rad", angle, 1}, "rad|radian|radians"},
    Known{{"deg", "rad", angle, kDegree},
          "deg|degree|degrees|Grad|grado|grados|gradi|grau|graus|graden|degr\xC3\xA9|degr\xC3\xA9s|"
          "degre|degres"},
    Known{{"mrad", "rad", angle, 1e-3}, "mrad"},
    Known{{"urad", "rad", angle, 1e-6}, "urad"},
    Known{{"gon", "rad", angle, kTurn / 400}, "gon|gons"},
    Known{{"arcmin", "rad", angle, kDegree / 60}, "arcmin|arcmins|arcminutes"},
    Known{{"arcsec", "rad", angle, kDegree / 3600}, "arcsec|arcsecs|arcseconds"},
    Known{{"mdeg", "rad", angle, 1e-3 * kDegree}, "mdeg"},
    Known{{"rev", "rad", angle, kTurn},
          "rev|revs|revolution|revolutions|turn|turns|rotation|rotations|Umdr|Umdrehungen|U|tr|"
          "tours|giri|vueltas"},
    Known{{"counts", "rad", angle, kTurn, 0, true},
          "counts|count|cnt|cnts|tick|ticks|inc|incs|increments|pulses|qc"},
    Known{{"rad/s", "rad/s", angular_velocity, 1},
          "rad/s|rad_s|rad/sec|radps|rad_per_s|rad_per_sec|rads-1"},
    Known{{"deg/s", "rad/s", angular_velocity, kDegree},

          "deg/s|deg_s|deg/sec|degps|dps|deg_per_s|deg_per_sec|degs-1|Grad/s|grados/s|gradi/s"},
    Known{{"mrad/s", "rad/s", angular_velocity, 1e-3}, "mrad/s|mrad_s"},
    Known{{"rpm", "rad/s", angular_velocity, kTurn / 60},
          "rpm|rev/min|rev_min|r/min|1/min|min-1|u/min|turns/min|Umdr/min|UpM|tr/min|giri/min"},
    Known{{"rev/s", "rad/s", angular_velocity, kTurn},
          "rev/s|rev_s|rps|turn/s|turns/s|U/s|Umdr/s|tr/s|giri/s"},
    Known{{"counts/s", "rad/s", angular_velocity, kTurn, 0, true},
          "counts/s|counts_s|cnt/s|cnts/s|ticks/s|ticks_s|inc/s|cps"},
    Known{{"rad/s^2", "rad/s^2", angular_acceleration, 1},
          "rad/s2|rad_s2|rad/s/s|rad/sec2|radps2|rad_per_s2|rads-2"},
    Known{{"deg/s^2", "rad/s^2", angular_acceleration, kDegree},
          "deg/s2|deg_s2|deg/s/s|deg/sec2|dps2|deg_per_s2|degs-2"},
    Known{{"rpm/s", "rad/s^2", angular_acceleration, kTurn / 60}, "rpm/s|rpm_s"},
    Known{{"rev/s^2", "rad/s^2", angular_acceleration, kTurn}, "rev/s2|rev_s2"},
    Known{{"m", "m", length, 1}, "m|meter|meters|metre|metres"},
    Known{{"mm", "m", length, 1e-3}, "mm|millimeter|millimeters"},
    Known{{"cm", "m", length, 1e-2}, "cm"},
    Known{{"um", "m", length, 1e-6}, "um"},
    Known{{"in", "m", length, 0.0254}, "in|inch|inches"},
    Known{{"m/s", "m/s", speed, 1}, "m/s|m_s|m/sec|mps|m_per_s|ms-1"},
    Known{{"mm/s", "m/s", speed, 1e-3}, "mm/s|mm_s|mm/sec|mmps|mm_per_s|mms-1"},
    Known{{"cm/s", "m/s", speed, 1e-2}, "cm/s|cm_s"},
    Known{{"m/min", "m/s", speed, 1.0 / 60}, "m/min"},
    Known{{"mm/min", "m/s", speed, 1e-3 / 60}, "mm/min"},
    Known{{"in/s", "m/s", speed, 0.0254}, "in/s|in/sec|inch/s|ips"},
    Known{{"m/s^2", "m/s^2", linear_acceleration, 1}, "m/s2|m_s2|m/s/s|m/sec2|mps2|ms-2"},
    Known{{"mm/s^2", "m/s^2", linear_acceleration, 1e-3}, "mm/s2|mm_s2|mm/s/s|mms-2"},
    Known{{"in/s^2", "m/s^2", linear_acceleration, 0.0254}, "in/s2|in/sec2|inch/s2"},
    Known{{"s", "s", time, 1}, "s|sec|secs|second|seconds|Sek|Sekunden"},
    Known{{"ms", "s", time, 1e-3}, "ms|msec|msecs|millis|millisecond|milliseconds"},
    Known{{"us", "s", time, 1e-6}, "us|usec|usecs|micros|microsecond|microseconds"},
    Known{{"ns", "s", time, 1e-9}, "ns|nsec|nsecs|nanos|nanosec|nanosecs|nanosecond|nanoseconds"},
    Known{{"min", "s", time, 60}, "min|mins|minute|minutes|Minuten"},
    Known{{"h", "s", time, 3600}, "h|hr|hrs|hour|hours|Stunden"},
    Known{{"d", "s", time, 86400}, "d|day|days|Tage"},
    Known{
        {"N m", "N m", torque, 1},
        "Nm|N-m|N_m|newtonmeter|newtonmeters|newtonmetre|newtonmetres|newton-meter|newton-meters"},
    Known{{"mN m", "N m", torque, 1e-3}, "mNm|mN-m|mN_m"},
    Known{{"cN m", "N m", torque, 1e-2}, "cNm|cN-m|cN_m"},
    Known{{"N cm", "N m", torque, 1e-2}, "Ncm|N-cm|N_cm"},
    Known{{"N mm", "N m", torque, 1e-3}, "Nmm|N-mm|N_mm"},
    Known{{"kN m", "N m", torque, 1e3}, "kNm|kN-m|kN_m"},
    Known{{"kgf m", "N m", torque, 9.80665}, "kgfm|kgf-m|kgf_m|kgm|kg-m"},
    Known{{"kgf cm", "N m", torque, 0.0980665}, "kgfcm|kgf-cm|kgf_cm|kgcm|kg-cm"},
    Known{{"lbf ft", "N m", torque, 1.3558179483314004},
          "lbfft|lbf-ft|lbf_ft|lbft|lb-ft|lb_ft|ftlb|ft-lb|ft_lb|ftlbf|ft-lbf|ft_lbf|"
          "ftlbs|ft-lbs|ft_lbs|lbsft|lbs-ft|footpounds|foot-pounds"},
    Known{{"lbf in", "N m", torque, 0.1129848290276167},
          "lbfin|lbf-in|lbf_in|lbin|lb-in|lb_in|inlb|in-lb|in_lb|inlbf|in-lbf|in_lbf|"
          "inlbs|in-lbs|in_lbs|lbsin|lbs-in|inchpounds|inch-pounds"},
    Known{{"ozf in", "N m", torque, 0.00706155181422604},
          "ozfin|ozf-in|ozf_in|ozin|oz-in|oz_in|inoz|in-oz|in_oz|inozf|in-ozf|in_ozf"},
    Known{{"N", "N", force, 1}, "N|newton|newtons"},
    Known{{"mN", "N", force, 1e-3}, "mN"},
    Known{{"kN", "N", force, 1e3}, "kN"},
    Known{{"lbf", "N", force, 4.4482216152605}, "lbf"},
    Known{{"kgf", "N", force, 9.80665}, "kgf"},
    Known{{"A", "A", current, 1}, "A|amp|amps|ampere|amperes|Arms|A_rms|Aeff|A_eff|Apk|A_pk"},
    Known{{"mA", "A", current, 1e-3}, "mA|milliamp|milliamps|milliampere|mArms|mA_rms|mAeff"},
    Known{{"V", "V", voltage, 1}, "V|volt|volts"},
    Known{{"mV", "V", voltage, 1e-3}, "mV|millivolt|millivolts"},
    Known{{"degC", "degC", temperature, 1}, "degC|C|celsius|deg_C"},
    Known{{"K", "degC", temperature, 1, -273.15}, "K|kelvin"},
    Known{{"degF", "degC", temperature, 5.0 / 9, -32}, "degF|F|fahrenheit|deg_F"},
    Known{{"kg", "kg", mass, 1}, "kg"},
    Known{{"%", "%", share, 1}, "%|percent|pct"},
    Known{{"permille", "%", share, 0.1}, "permille|promille"},
};

void replace_all(std::string& text, std::string_view what, std::string_view with) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at)) {
    text.replace(at, what.size(), with);
    at += with.size();
  }
}

std::string plain_unit(std::string_view text) {
  std::string plain(text);
  constexpr std::array<std::pair<std::string_view, std::string_view>, 14> kSigns = {{
      {"\xE2\x80\xB0", "permille"},
      {"\xC2\xB0", "deg"},    // degree sign
      {"\xC2\xBA", "deg"},    // the ordinal's sign, which looks like it
      {"\xCB\x9A", "deg"},    // a ring
      {"\\circ", "deg"},      // LaTeX
      {"\xC2\xA0", ""},       // a blank that does not break
      {"\xC2\xB5", "u"},      // micro sign
      {"\xCE\xBC", "u"},      // mu
      {"\xC2\xB2", "2"},      // superscript 2
      {"\xC2\xB9", "1"},      // superscript 1
      {"\xE2\x81\xBB", "-"},  // superscript minus
      {"\xC2\xB7", ""},       // middle dot
      {"\xE2\x8B\x85", ""},   // dot operator
      {"\xB0", "deg"},        // degree sign in Latin-1
  }};
  for (const auto& [sign, word] : kSigns) replace_all(plain, sign, word);
  std::erase_if(
      plain, [](char c) { return std::string_view(" \t.*^$").find(c) != std::string_view::npos; });
  return plain;
}

using Spellings = std::map<std::string, const Unit*, std::less<>>;

// Of all units, as they are or in small letters; of two alike the first one's.
Spellings all_spellings(bool small) {
  Spellings all;
  for (const Known& known : kKnown) {
    for (const std::string& spelling : split(known.spellings, '|')) {
      all.try_emplace(small ? in_small_letters(spelling) : spelling, &known.unit);
    }
  }
  return all;
}

std::vector<Dimension> dimensions_of(Role role) {
  switch (role) {
    case Role::position:
      return {angle, length};
    case Role::velocity:
    case Role::other_velocity:
      return {angular_velocity, speed};
    case Role::acceleration:
    case Role::other_acceleration:
      return {angular_acceleration, linear_acceleration};
    case Role::time:
      return {time};
    case Role::temperature:
      return {temperature};
    case Role::motor_current:
      return {current, share};
    case Role::motor_torque:
    case Role::gravity_torque:
    case Role::friction_torque:
    case Role::external_torque:
      return {torque, force, current, voltage, share};
    default:
      return {};
  }
}

bool is_motion(Dimension dimension) {
  return dimension == angle || dimension == angular_velocity || dimension == angular_acceleration;
}

}  // namespace

const Unit* find_unit(std::string_view text) {
  static const Spellings kAsTheyAre = all_spellings(false);
  static const Spellings kSmall = all_spellings(true);
  const std::string plain = plain_unit(text);
  if (plain.empty()) return nullptr;
  if (const auto found = kAsTheyAre.find(plain); found != kAsTheyAre.end()) return found->second;
  const auto found = kSmall.find(in_small_letters(plain));
  return found != kSmall.end() ? found->second : nullptr;
}

std::string WrittenUnit::symbol() const {
  if (unit == nullptr) return {};
  return fmt::format("{}{}{}", scale == 1 ? std::string() : fmt::format("{} ", scale), unit->symbol,
                     at_motor ? "@motor" : "");
}

WrittenUnit find_written_unit(std::string_view text) {
  WrittenUnit written;
  constexpr std::string_view kMotor = "@motor";
  if (text.ends_with(kMotor)) {
    written.at_motor = true;
    text.remove_suffix(kMotor.size());
  }
  written.unit = find_unit(text);
  if (written.unit != nullptr) return written;  // "1/min" too
  while (text.starts_with(' ')) text.remove_prefix(1);
  double scale = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), scale);
  if (code != std::errc() || !std::isfinite(scale) || scale == 0) return {};
  written.scale = scale;
  written.unit = find_unit(text.substr(static_cast<std::size_t>(end - text.data())));
  return written.unit != nullptr ? written : WrittenUnit{};
}

bool measures_effort(const Unit& unit) {
  return unit.dimension == Dimension::torque || unit.dimension == Dimension::force ||
         unit.dimension == Dimension::current || unit.dimension == Dimension::voltage;
}

bool suits(const Unit& unit, Role role) {
  const std::vector<Dimension> dimensions = dimensions_of(role);
  return dimensions.empty() || std::ranges::count(dimensions, unit.dimension) > 0;
}

std::string units_of(Role role) {
  std::vector<std::string_view> symbols;
  for (const Known& known : kKnown) {
    if (std::ranges::count(dimensions_of(role), known.unit.dimension) > 0) {
      symbols.push_back(known.unit.symbol);
    }
  }
  return fmt::format("{}", fmt::join(symbols, ", "));
}

std::string nearest_unit(std::string_view text, Role role) {
  std::vector<std::string> spellings;
  for (const Known& known : kKnown) {
    if (std::ranges::count(dimensions_of(role), known.unit.dimension) == 0) continue;
    spellings.emplace_back(known.spellings.substr(0, known.spellings.find('|')));
  }
  const Unit* unit = find_unit(nearest_name(plain_unit(text), spellings));
  return unit != nullptr ? std::string(unit->symbol) : std::string();
}

Converted conversion_of(const WrittenUnit& written, const Drive& drive) {
  const Unit& unit = *written.unit;
  Converted out{{unit.factor * written.scale, unit.offset / written.scale, std::string(unit.si)},
                {}};
  if (unit.counts && !drive.counts_per_turn) {
    out.needs = "--counts-per-turn N (of the encoder, after quadrature)";
  } else if (unit.counts) {
    out.conversion.factor /= *drive.counts_per_turn;
  }
  if (!written.at_motor || (!is_motion(unit.dimension) && unit.dimension != torque)) return out;
  if (!drive.gear_ratio) {
    out.needs += fmt::format("{}--gear-ratio N (turns of the motor a turn of the joint)",
                             out.needs.empty() ? "" : " and ");
  } else {
    out.conversion.factor *= unit.dimension == torque ? *drive.gear_ratio : 1 / *drive.gear_ratio;
  }
  return out;
}

}  // namespace tribench
