// SPDX-License-Identifier: MIT
#include "harness/study/retelling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>

#include "foundation/error.hpp"
#include "foundation/suggestion.hpp"
#include "problems/reading/channel_names.hpp"

namespace tribench {
namespace {

constexpr double kEpoch2023_s = 1.7e9;  // seconds since 1970, as a controller's clock has them
constexpr double kRounding = 1e-9;      // of errors that sums in another order make
constexpr std::string_view kUnordered = "--unordered";

// The value of an option of `loop`; empty where it is not given.
std::string_view option_of(const RecordingToTell& recording, std::string_view name) {
  const auto found = std::ranges::find(recording.options, name);
  if (found == recording.options.end() || found + 1 == recording.options.end()) return {};
  return *(found + 1);
}

// What --roles says of a column ("motor_current[mA]": the role alone), else its name.
Role role_of(const RecordingToTell& recording, std::string_view column) {
  std::string_view roles = option_of(recording, "--roles");
  while (!roles.empty()) {
    const std::string_view part = roles.substr(0, roles.find(','));
    roles.remove_prefix(std::min(part.size() + 1, roles.size()));
    const std::size_t equals = part.find('=');
    if (part.substr(0, equals) != column || equals == std::string_view::npos) continue;
    const std::string_view role = part.substr(equals + 1);
    return find_role(role.substr(0, role.find('[')));
  }
  return read_channel_name(column).role;
}

bool is_signed(Role role) {
  constexpr std::array kSigned = {Role::position,          Role::velocity,     Role::velocity_sign,
                                  Role::acceleration,      Role::gravity_sign, Role::other_velocity,
                                  Role::other_acceleration};
  return is_torque_like(role) || std::ranges::count(kSigned, role) > 0;
}

void change_numbers(CsvCells& cells, std::size_t column,
                    const std::function<double(double)>& change) {
  for (CsvLine& line : cells.lines) {
    if (line.blank()) continue;
    double value = 0;
    if (read_cell(line.cells[column], false, value) != CellKind::number) continue;
    line.cells[column] = fmt::format("{}", change(value));
  }
}

// Changes the numbers of every column of a role; false where there is none.
bool change_roles(RecordingToTell& recording, const std::function<bool(Role)>& which,
                  const std::function<double(double)>& change) {
  bool any = false;
  for (RecordingFile& file : recording.files) {
    for (std::size_t c = 0; c < file.cells.header.size(); ++c) {
      if (!which(role_of(recording, file.cells.header[c]))) continue;
      change_numbers(file.cells, c, change);
      any = true;
    }
  }
  return any;
}

std::optional<std::size_t> movement_column(const RecordingToTell& recording,
                                           const CsvCells& cells) {
  for (std::size_t c = 0; c < cells.header.size(); ++c) {
    if (role_of(recording, cells.header[c]) == Role::movement) return c;
  }
  return std::nullopt;
}

// The lines of one movement, which stand together.
using Movement = std::vector<CsvLine>;

std::vector<Movement> movements_of(const RecordingToTell& recording, const CsvCells& cells) {
  const std::optional<std::size_t> column = movement_column(recording, cells);
  std::vector<Movement> movements;
  for (const CsvLine& line : cells.lines) {
    if (line.blank()) continue;
    const bool starts = movements.empty() ||
                        (column && line.cells[*column] != movements.back().back().cells[*column]);
    if (starts) movements.emplace_back();
    movements.back().push_back(line);
  }
  return movements;
}

void put_movements(CsvCells& cells, const std::vector<Movement>& movements) {
  cells.lines.clear();
  for (const Movement& movement : movements) {
    cells.lines.insert(cells.lines.end(), movement.begin(), movement.end());
  }
}

std::size_t count_movements(const RecordingToTell& recording) {
  std::size_t count = 0;
  for (const RecordingFile& file : recording.files) {
    count += movements_of(recording, file.cells).size();
  }
  return count;
}

std::optional<RecordingToTell> mirror(const RecordingToTell& recording, RandomStream /*random*/) {
  RecordingToTell told = recording;
  change_roles(told, is_signed, [](double x) { return -x; });
  return told;
}

template <int kNumerator, int kDenominator>
std::optional<RecordingToTell> in_another_torque(const RecordingToTell& recording,
                                                 RandomStream /*random*/) {
  RecordingToTell told = recording;
  change_roles(told, is_torque_like, [](double x) { return x * kNumerator / kDenominator; });
  told.torque_unit = recording.torque_unit * kDenominator / kNumerator;
  return told;
}

// Radians as degrees, where the columns' own names say the unit.
std::optional<RecordingToTell> in_degrees(const RecordingToTell& recording,
                                          RandomStream /*random*/) {
  RecordingToTell told = recording;
  bool any = false;
  for (RecordingFile& file : told.files) {
    for (std::size_t c = 0; c < file.cells.header.size(); ++c) {
      std::string& name = file.cells.header[c];
      const std::size_t unit = name.rfind("_rad");
      const NameReading reading = read_channel_name(name);
      const bool named = std::ranges::any_of(recording.options, [&](const std::string& option) {
        return option.find(name) != std::string::npos;
      });
      if (unit == std::string::npos || named || reading.role == Role::none ||
          !reading.unit.starts_with("rad")) {
        continue;
      }
      name.replace(unit, 4, "_deg");
      change_numbers(file.cells, c, [](double x) { return x * 180 / std::numbers::pi; });
      any = true;
    }
  }
  return any ? std::optional(told) : std::nullopt;
}

std::optional<RecordingToTell> shuffle_columns(const RecordingToTell& recording,
                                               RandomStream random) {
  RecordingToTell told = recording;
  for (RecordingFile& file : told.files) {
    std::vector<std::size_t> order(file.cells.header.size());
    std::iota(order.begin(), order.end(), 0);
    random.shuffle(std::span(order));
    const auto reorder = [&order](std::vector<std::string>& cells) {
      std::vector<std::string> moved;
      for (const std::size_t c : order) moved.push_back(std::move(cells[c]));
      cells = std::move(moved);
    };
    reorder(file.cells.header);
    for (CsvLine& line : file.cells.lines) {
      if (!line.blank()) reorder(line.cells);
    }
  }
  return told;
}

std::optional<RecordingToTell> shuffle_movements(const RecordingToTell& recording,
                                                 RandomStream random) {
  if (count_movements(recording) < 2) return std::nullopt;
  RecordingToTell told = unordered(recording);
  for (RecordingFile& file : told.files) {
    std::vector<Movement> movements = movements_of(recording, file.cells);
    random.shuffle(std::span(movements));
    put_movements(file.cells, movements);
  }
  random.shuffle(std::span(told.files));
  return told;
}

std::optional<RecordingToTell> shift_time(const RecordingToTell& recording,
                                          RandomStream /*random*/) {
  RecordingToTell told = recording;
  const bool any = change_roles(
      told, [](Role role) { return role == Role::time; },
      [](double t) { return t + kEpoch2023_s; });
  return any ? std::optional(told) : std::nullopt;
}

// Names that sort in another order than the campaign's. A movement that is read from a column of
// numbers keeps numbers.
std::optional<RecordingToTell> rename_movements(const RecordingToTell& recording,
                                                RandomStream /*random*/) {
  RecordingToTell told = recording;
  std::size_t number = 0;
  for (RecordingFile& file : told.files) {
    const std::optional<std::size_t> column = movement_column(recording, file.cells);
    if (!column) {
      file.name = fmt::format("run {}.csv", 9000 - ++number);
      continue;
    }
    std::vector<Movement> movements = movements_of(recording, file.cells);
    for (Movement& movement : movements) {
      const std::string name = fmt::format("{}", 9000 - ++number);
      for (CsvLine& line : movement) line.cells[*column] = name;
    }
    put_movements(file.cells, movements);
  }
  return told;
}

std::optional<RecordingToTell> with_another_seed(const RecordingToTell& recording,
                                                 RandomStream random) {
  RecordingToTell told = recording;
  told.seed = recording.seed + 1 + random.below(1'000'000);
  return told;
}

// Of each movement, from its row `first` on.
template <std::size_t first>
std::optional<RecordingToTell> every_second_row(const RecordingToTell& recording,
                                                RandomStream /*random*/) {
  RecordingToTell told = recording;
  for (RecordingFile& file : told.files) {
    std::vector<Movement> movements = movements_of(recording, file.cells);
    for (Movement& movement : movements) {
      Movement kept;
      for (std::size_t i = first; i < movement.size(); i += 2) kept.push_back(movement[i]);
      movement = std::move(kept);
    }
    put_movements(file.cells, movements);
  }
  return told;
}

// Leaves out the movements, numbered through all files, that are marked.
std::optional<RecordingToTell> without(const RecordingToTell& recording,
                                       const std::vector<char>& left_out) {
  RecordingToTell told = recording;
  std::size_t number = 0;
  for (RecordingFile& file : told.files) {
    std::vector<Movement> kept;
    for (Movement& movement : movements_of(recording, file.cells)) {
      if (left_out[number++] == 0) kept.push_back(std::move(movement));
    }
    put_movements(file.cells, kept);
  }
  std::erase_if(told.files, [](const RecordingFile& file) { return file.cells.lines.empty(); });
  return told;
}

std::optional<RecordingToTell> without_the_last_tenth(const RecordingToTell& recording,
                                                      RandomStream /*random*/) {
  const std::size_t count = count_movements(recording);
  if (count < 10) return std::nullopt;
  std::vector<char> left_out(count);
  std::fill(left_out.end() - static_cast<std::ptrdiff_t>(count / 10), left_out.end(), 1);
  return without(recording, left_out);
}

std::optional<RecordingToTell> without_any_tenth(const RecordingToTell& recording,
                                                 RandomStream random) {
  const std::size_t count = count_movements(recording);
  if (count < 10) return std::nullopt;
  std::vector<char> left_out(count);
  std::fill(left_out.end() - static_cast<std::ptrdiff_t>(count / 10), left_out.end(), 1);
  random.shuffle(std::span(left_out));
  return without(recording, left_out);
}

}  // namespace

const std::vector<Retelling>& retellings() {
  constexpr double kAny = std::numeric_limits<double>::infinity();
  // Doubles since 1970 resolve 2.4e-7 s.
  constexpr double kOfTheClock = 1e-6;
  static const std::vector<Retelling> kRetellings = {
      {"mirrored", "every signed quantity negated", 1, 0, false, mirror},
      {"torque_x1024", "torques in a unit 1024 times as small", 1, 0, false,
       in_another_torque<1024, 1>},
      {"torque_x1000", "torques in thousandths", 1, kRounding, false, in_another_torque<1000, 1>},
      {"torque_x0.001", "torques in thousands", 1, kRounding, false, in_another_torque<1, 1000>},
      {"degrees", "angles in degrees", 1, kRounding, false, in_degrees},
      {"columns", "columns in another order", 1, 0, false, shuffle_columns},
      {"movements", "movements in another order, with --unordered", 1, kRounding, true,
       shuffle_movements},
      {"epoch", "time since 1970", 1, kOfTheClock, false, shift_time},
      {"renamed", "movements under other names", 1, 0, false, rename_movements},
      {"seed", "another --seed", 0.97, kAny, false, with_another_seed},
      {"second_rows", "every second row", 0.95, kAny, false, every_second_row<0>},
      {"other_rows", "the rows between those", 0.95, kAny, false, every_second_row<1>},
      {"last_tenth", "without the last tenth of the movements", 0.95, kAny, false,
       without_the_last_tenth},
      {"any_tenth", "without a tenth of the movements, drawn", 0.95, kAny, false,
       without_any_tenth}};
  return kRetellings;
}

const Retelling& find_retelling(std::string_view name) {
  std::vector<std::string> names;
  for (const Retelling& one : retellings()) {
    if (one.name == name) return one;
    names.emplace_back(one.name);
  }
  throw_bad_input(fmt::format("there is no retelling '{}'", name), "--retellings",
                  did_you_mean(name, names));
}

RecordingToTell unordered(RecordingToTell recording) {
  if (std::ranges::find(recording.options, kUnordered) == recording.options.end()) {
    recording.options.emplace_back(kUnordered);
  }
  return recording;
}

}  // namespace tribench
