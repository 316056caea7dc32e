// SPDX-License-Identifier: MIT
#include "problems/preparation/observations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "foundation/error.hpp"
#include "foundation/sign.hpp"
#include "problems/preparation/derived_channels.hpp"
#include "problems/preparation/observation_rows.hpp"
#include "problems/preparation/slow_temperature.hpp"
#include "problems/reading/units.hpp"

namespace tribench::loop {
namespace {

constexpr double kFewestAveraged = 1.2;  // rows of a mean; fewer gain nothing

constexpr double kThermometer = 1e-3;  // K: less of noise and steps is not spoken of

constexpr std::array<std::pair<Role, std::string_view>, 10> kSignalNames = {{
    {Role::velocity, "v"},
    {Role::velocity_sign, "sgn_v"},
    {Role::acceleration, "a"},
    {Role::gravity_torque, "g"},
    {Role::gravity_sign, "sgn_g"},
    {Role::position, "q"},
    {Role::temperature, "T"},
    {Role::time, "t"},
    {Role::other_velocity, "v2"},
    {Role::other_acceleration, "a2"},
}};

void add_sign(Observations& data, std::string_view of, Role role) {
  const std::string name = "sgn_" + std::string(of);
  const Signal* source = data.find(of);
  if (source == nullptr || data.find(name) != nullptr) return;
  Signal signal{name, source->channel, "-", role, {}, source->values};
  for (double& x : signal.values) x = sign(x);
  data.signals.push_back(std::move(signal));
}

// Time through the campaign. Where it restarts with the movements, they follow one another in the
// order of the file; without a time, a movement's number stands for it.
void add_campaign_time(Observations& data) {
  const auto found = std::ranges::find(data.signals, "t", &Signal::name);
  if (found == data.signals.end()) {
    Signal signal{"t", "", "movement", Role::time, "number of the movement in the file", {}};
    for (const int m : data.movement) signal.values.push_back(m);
    data.signals.push_back(std::move(signal));
    return;
  }
  double offset = 0;
  bool restarts = false;
  for (std::size_t i = 1; i < data.rows(); ++i) {
    const double before = found->values[i - 1];
    if (data.movement[i] != data.movement[i - 1] && found->values[i] + offset < before) {
      offset = before - found->values[i];
      restarts = true;
    }
    found->values[i] += offset;
  }
  if (restarts) found->recipe = "time of the movements laid end to end";
}

// Per row whether it is seen how far back the last reversal lies: from a movement's first change of
// direction on, or throughout where it starts from standstill.
std::vector<char> reversal_is_seen(const Observations& data, const std::vector<double>& v) {
  std::vector<char> seen(v.size(), 0);
  for (std::size_t begin = 0, end = 0; begin < v.size(); begin = end) {
    double top = 0;
    for (end = begin; end < v.size() && data.movement[end] == data.movement[begin]; ++end) {
      top = std::max(top, std::abs(v[end]));
    }
    std::size_t from = begin;
    if (!starts_from_rest(v[begin], v[std::min(begin + 1, end - 1)], kStandstill * top)) {
      while (from < end && !(v[from] * v[begin] < 0)) ++from;
    }
    std::fill(seen.begin() + static_cast<std::ptrdiff_t>(from),
              seen.begin() + static_cast<std::ptrdiff_t>(end), char{1});
  }
  return seen;
}

// Without its thermometer's noise and steps, and says how large they were.
void smooth_temperature(Observations& data) {
  const auto temperature = std::ranges::find(data.signals, "T", &Signal::name);
  const Signal* t = data.find("t");
  if (temperature == data.signals.end() || t->unit != "s") return;
  std::vector<double> slow = slow_temperature(temperature->values, t->values, data.movement);
  double squares = 0;
  for (std::size_t i = 0; i < slow.size(); ++i) {
    const double change = temperature->values[i] - slow[i];
    squares += change * change;
  }
  temperature->values = std::move(slow);
  const double noise = std::sqrt(squares / static_cast<double>(data.rows()));
  if (noise < kThermometer) return;
  data.warnings.push_back(
      fmt::format("'{}' is a straight line over any {:.0f} s of a movement: what its readings have "
                  "beside it, {:.2g} {}, is the thermometer's",
                  temperature->channel, kThermalSeconds, noise, temperature->unit));
}

// Path since the velocity last changed its sign; starts at 0 with every movement. None where no
// reversal is seen: "distance" would be a name for the place within a recording.
void add_distance(Observations& data) {
  if (data.find("d") != nullptr) return;
  const Signal* v = data.find("v");
  const Signal* q = data.find("q");
  const Signal* t = data.find("t");
  const bool timed = t != nullptr && t->recipe != "number of the movement in the file";
  if (v == nullptr || (q == nullptr && !timed)) return;
  const std::vector<char> seen = reversal_is_seen(data, v->values);
  if (std::ranges::count(seen, 1) == 0) return;
  Signal signal{"d", "", q != nullptr ? q->unit : v->unit + " s", Role::none, {}, {}};
  signal.recipe = distance_recipe();
  DistanceSinceReversal distance(q != nullptr ? PathFrom::position : PathFrom::velocity);
  for (std::size_t i = 0; i < data.rows(); ++i) {
    const bool starts = i == 0 || data.movement[i] != data.movement[i - 1];
    if (starts) distance.start_movement();
    const double dt = timed && !starts ? t->values[i] - t->values[i - 1] : 0;
    signal.values.push_back(distance.next(v->values[i], q != nullptr ? q->values[i] : 0, dt));
  }
  data.signals.push_back(signal);
  // A movement that starts in motion has turned before the recording began.
  signal.values = seen_distance(std::move(signal.values), seen);
  if (signal.values.empty()) return;
  signal.name = kSeenDistance;
  signal.recipe = seen_distance_recipe();
  data.signals.push_back(std::move(signal));
}

// Of several movements: within one it is the time of the recording.
void add_time_since_start(Observations& data) {
  const Signal& t = *data.find("t");
  if (t.unit != "s" || data.movements().size() < 2) return;
  Signal since{std::string(Signal::kSinceStart),         t.channel, "s", Role::none,
               "seconds since the movement's first row", {}};
  double start = 0;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    if (i == 0 || data.movement[i] != data.movement[i - 1]) start = t.values[i];
    since.values.push_back(t.values[i] - start);
  }
  data.signals.push_back(std::move(since));
}

// To first order a late velocity differs from the velocity by the acceleration: without one, an
// inertia that the data do not hold would pass for late friction.
void add_late_channels(Observations& data, MovementOrder order) {
  const Signal* t = data.find("t");
  if (t == nullptr || t->unit != "s" || data.find("a") == nullptr) return;
  const std::vector<double> time = t->values;
  const Signal v = *data.find("v");
  for (const LateChannel& late : LateChannel::all()) {
    if (data.find(late.name()) != nullptr) continue;  // told before rows were cut
    data.signals.push_back({late.name(), v.channel, late.unit(v.unit), Role::none, late.recipe(),
                            late.values(v.values, time, data.movement, order)});
  }
}

const Channel& needed_target(const Dataset& data) {
  for (const Role role : {Role::friction_torque, Role::motor_torque, Role::motor_current}) {
    if (const Channel* channel = data.find(role)) return *channel;
  }
  throw_bad_input("there is no friction or motor torque among the columns", data.name,
                  "name it: --roles COLUMN=friction_torque or COLUMN=motor_torque");
}

void set_target(Observations& out, const Dataset& data) {
  const Channel& target = needed_target(data);
  out.target = target.values;
  out.target_name = target.name;
  out.target_unit = target.unit;
  const Channel* gravity = data.find(Role::gravity_torque);
  if (target.role != Role::friction_torque) {
    if (gravity != nullptr && gravity->unit == target.unit) {
      for (std::size_t i = 0; i < out.target.size(); ++i) out.target[i] -= gravity->values[i];
      out.target_name = fmt::format("{} - {}", target.name, gravity->name);
    } else {
      if (gravity != nullptr) out.rigid.push_back("g");
      if (data.find(Role::acceleration) != nullptr) out.rigid.push_back("a");
    }
  }
}

}  // namespace

std::vector<std::string> known_signal_names() {
  std::vector<std::string> names;
  for (const auto& [role, name] : kSignalNames) names.emplace_back(name);
  for (const std::string_view name : {std::string_view("d"), kSeenDistance, Signal::kSinceStart}) {
    names.emplace_back(name);
  }
  for (const LateChannel& late : LateChannel::all()) names.push_back(late.name());
  return names;
}

std::string signal_name(Role role, std::string_view channel) {
  for (const auto& [known, name] : kSignalNames) {
    if (known == role) return std::string(name);
    if (role == Role::none && name == channel) return std::string(name) + "_";
  }
  return std::string(channel);
}

void complete_signals(Observations& data) {
  drop_rows_not_finite(data);
  if (data.rows() == 0) {
    throw_bad_input("no row has a finite value in every channel", data.target_name,
                    "check the columns for gaps");
  }
  add_sign(data, "v", Role::velocity_sign);
  add_sign(data, "g", Role::gravity_sign);
}

const Signal* Observations::find(std::string_view name) const {
  const auto found = std::ranges::find(signals, name, &Signal::name);
  return found == signals.end() ? nullptr : &*found;
}

std::vector<std::string> Observations::names() const {
  std::vector<std::string> names;
  for (const Signal& signal : signals) names.push_back(signal.name);
  return names;
}

void Observations::take_away(std::string_view name, std::string why) {
  if (std::erase_if(signals, [&](const Signal& signal) { return signal.name == name; }) > 0) {
    withheld.push_back({std::string(name), std::move(why)});
  }
}

std::string Observations::name_of(int number) const {
  return movement_names.empty() ? std::to_string(number)
                                : movement_names[static_cast<std::size_t>(number)];
}

std::vector<int> Observations::movements() const {
  std::vector<int> numbers;
  for (const int m : movement) {
    if (numbers.empty() || numbers.back() != m) numbers.push_back(m);
  }
  return numbers;
}

Observations Observations::select(const std::vector<char>& keep) const {
  const auto chosen = [&](const auto& values) {
    std::decay_t<decltype(values)> out;
    if (values.empty()) return out;
    out.reserve(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (keep[i] != 0) out.push_back(values[i]);
    }
    return out;
  };
  const auto chosen_signals = [&](const std::vector<Signal>& from) {
    std::vector<Signal> out;
    for (const Signal& signal : from) {
      out.push_back({signal.name, signal.channel, signal.unit, signal.role, signal.recipe, {}});
      out.back().values = chosen(signal.values);
    }
    return out;
  };
  Observations out;
  out.target = chosen(target);
  out.movement = chosen(movement);
  out.time = chosen(time);
  out.place = chosen(place);
  out.signals = chosen_signals(signals);
  out.unused = chosen_signals(unused);
  out.target_name = target_name;
  out.target_unit = target_unit;
  out.movement_names = movement_names;
  out.group = group;
  out.group_name = group_name;
  out.turns_left_out = turns_left_out;
  out.rigid = rigid;
  out.withheld = withheld;
  out.warnings = warnings;
  return out;
}

namespace {

// The number of each row within its movement.
std::vector<std::size_t> places_of(const std::vector<int>& movement) {
  std::vector<std::size_t> place(movement.size(), 0);
  for (std::size_t i = 1; i < movement.size(); ++i) {
    place[i] = movement[i] == movement[i - 1] ? place[i - 1] + 1 : 0;
  }
  return place;
}

// The least power of two such that one in so many of `rows` are at most `most`.
std::size_t step_to(std::size_t most, std::size_t rows) {
  return std::bit_ceil((rows + most - 1) / most);
}

}  // namespace

Observations Observations::thinned(std::size_t most) const {
  if (rows() <= most) return *this;
  const std::size_t step = step_to(most, rows());
  const std::vector<std::size_t> recorded = place.empty() ? places_of(movement) : place;
  std::vector<char> keep(rows(), 0);
  for (std::size_t i = 0; i < rows(); ++i) keep[i] = recorded[i] % step == 0 ? 1 : 0;
  return select(keep);
}

namespace {

// The number of the block that each row belongs to.
std::vector<std::size_t> blocks_of(const Observations& data, std::size_t longest) {
  const std::vector<double>& v = data.find("v")->values;
  const Signal* q = data.find("q");
  const double reach = q != nullptr && q->unit == "m" ? kBlockLength : kBlockAngle;
  double top = 0;
  for (const double speed : v) top = std::max(top, std::abs(speed));
  std::vector<std::size_t> block(data.rows(), 0);
  for (std::size_t i = 1, begin = 0; i < data.rows(); ++i) {
    const bool goes_on = data.movement[i] == data.movement[begin] && i - begin < longest &&
                         sign(v[i]) == sign(v[begin]) &&
                         std::abs(v[i] - v[begin]) <= kBlockSpeed * top &&
                         (q == nullptr || std::abs(q->values[i] - q->values[begin]) <= reach);
    block[i] = block[i - 1] + (goes_on ? 0 : 1);
    if (!goes_on) begin = i;
  }
  return block;
}

// Where the mean that begins with each row ends: one for each cell of `size` recorded rows, over
// the rows from its first on that say the same. 0 where none begins.
std::vector<std::size_t> ends_of_means(const Observations& data, std::size_t size,
                                       const std::vector<std::size_t>& place) {
  const std::vector<double>& v = data.find("v")->values;
  const Signal* q = data.find("q");
  const double reach = q != nullptr && q->unit == "m" ? kBlockLength : kBlockAngle;
  double top = 0;
  for (const double speed : v) top = std::max(top, std::abs(speed));
  const auto same_cell = [&](std::size_t a, std::size_t b) {
    return data.movement[a] == data.movement[b] && place[a] / size == place[b] / size;
  };
  std::vector<std::size_t> end(data.rows(), 0);
  for (std::size_t i = 0; i < data.rows(); ++i) {
    if (i > 0 && same_cell(i - 1, i)) continue;
    end[i] = i + 1;
    while (end[i] < data.rows() && same_cell(i, end[i]) && sign(v[end[i]]) == sign(v[i]) &&
           std::abs(v[end[i]] - v[i]) <= kBlockSpeed * top &&
           (q == nullptr || std::abs(q->values[end[i]] - q->values[i]) <= reach)) {
      ++end[i];
    }
  }
  return end;
}

// Means of the rows from each that one begins with to its end.
Observations means_of(const Observations& data, const std::vector<std::size_t>& end) {
  std::vector<char> first(data.rows(), 0);
  for (std::size_t i = 0; i < data.rows(); ++i) first[i] = end[i] > 0 ? 1 : 0;
  Observations out = data.select(first);
  const auto average = [&](const std::vector<double>& values, std::vector<double>& means) {
    std::size_t k = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (end[i] == 0) continue;
      double sum = 0;
      for (std::size_t j = i; j < end[i]; ++j) sum += values[j];
      means[k++] = sum / static_cast<double>(end[i] - i);
    }
  };
  average(data.target, out.target);
  average(data.time, out.time);
  for (std::size_t j = 0; j < data.signals.size(); ++j) {
    average(data.signals[j].values, out.signals[j].values);
  }
  for (std::size_t j = 0; j < data.unused.size(); ++j) {
    average(data.unused[j].values, out.unused[j].values);
  }
  for (Signal& signal : out.signals) {
    const Signal* of = signal.name.starts_with("sgn_") ? out.find(signal.name.substr(4)) : nullptr;
    for (std::size_t k = 0; of != nullptr && k < signal.values.size(); ++k) {
      signal.values[k] = sign(of->values[k]);
    }
  }
  return out;
}

}  // namespace

Shortened Observations::averaged(std::size_t most) const {
  if (rows() <= most) return {*this, 1, {}};
  const std::vector<std::size_t> block = blocks_of(*this, (rows() + most - 1) / most);
  const std::size_t blocks = block.back() + 1;
  std::vector<std::size_t> end(rows(), 0);
  std::size_t step = 1;
  if (rows() >= 2 * blocks) {
    step = (blocks + most - 1) / most;
    for (std::size_t i = 0, number = 0; i < rows(); ++i) {
      if (i > 0 && block[i] == block[i - 1]) continue;
      if (i > 0 && movement[i] != movement[i - 1]) number = 0;
      if (number++ % step != 0) continue;
      for (end[i] = i; end[i] < rows() && block[end[i]] == block[i];) ++end[i];
    }
  } else {
    end = ends_of_means(*this, step_to(most, rows()), place.empty() ? places_of(movement) : place);
  }
  std::size_t means = 0;
  std::size_t averaged_rows = 0;
  for (std::size_t i = 0; i < rows(); ++i) {
    means += end[i] > 0 ? 1 : 0;
    averaged_rows += end[i] > 0 ? end[i] - i : 0;
  }
  const double rows_each = static_cast<double>(averaged_rows) / static_cast<double>(means);
  if (rows_each < kFewestAveraged) return {thinned(most), 1, ", evenly spaced"};
  return {means_of(*this, end), rows_each, step > 1 ? fmt::format(", one mean in {}", step) : ""};
}

namespace {

// Without a role, varying, and not another torque.
bool is_spare(const Channel& channel) {
  const std::vector<double>& values = channel.values;
  const Unit* unit = find_unit(channel.unit);
  return channel.role == Role::none && (unit == nullptr || !measures_effort(*unit)) &&
         std::ranges::all_of(values, [](double x) { return std::isfinite(x); }) &&
         std::ranges::adjacent_find(values, std::ranges::not_equal_to()) != values.end();
}

// A channel that effects are written in, or that is rigid, or that may be worth a role; the first
// where there are two of a role.
void add_signal(Observations& out, const Channel& channel, bool rigid) {
  const std::optional<DerivedSignal> derived = derived_signal(channel.name);
  const bool recorded_distance = channel.name.starts_with("distance_since_reversal");
  const bool wanted =
      std::ranges::count(kSignalNames, channel.role, &std::pair<Role, std::string_view>::first) > 0;
  const std::string name = derived             ? derived->signal
                           : recorded_distance ? "d"
                                               : signal_name(channel.role, channel.name);
  const bool taken = wanted || rigid || derived || recorded_distance;
  if (!taken && is_spare(channel)) {
    out.unused.push_back({name, channel.name, channel.unit, channel.role, {}, channel.values});
  }
  if (!taken || out.find(name) != nullptr) return;
  out.signals.push_back({name, channel.name, channel.unit, channel.role,
                         derived ? derived->recipe : std::string(), channel.values,
                         channel.formula});
  if (rigid) out.rigid.push_back(name);
}

}  // namespace

Observations observe(const Dataset& data, const ObservationOptions& options) {
  if (data.rows() == 0) throw_bad_input("the file has no rows", data.name);
  if (data.find(Role::velocity) == nullptr) {
    throw_bad_input("there is no velocity among the columns", data.name,
                    "name it: --roles COLUMN=velocity");
  }
  Observations out;
  set_target(out, data);
  out.movement = data.movement;
  out.movement_names = data.movement_names;
  out.place = places_of(data.movement);
  for (const Channel& channel : data.channels) {
    if (channel.values.size() != data.rows()) continue;  // a text column: movement
    add_signal(out, channel, std::ranges::count(options.rigid, channel.name) > 0);
  }
  for (const std::string& name : options.rigid) data.at(name);
  complete_signals(out);
  add_campaign_time(out);
  smooth_temperature(out);
  add_distance(out);
  if (!options.steady) add_time_since_start(out);
  add_late_channels(out, options.unordered ? MovementOrder::unknown : MovementOrder::told);
  out.time = out.find("t")->values;
  check_moving(out);
  if (options.unordered) out.take_away("t", "the movements' order says nothing");
  if (options.min_speed.value_or(0) > 0) drop_slow_rows(out, *options.min_speed);
  if (!options.min_speed && !options.steady) drop_rows_at_rest(out);
  settle_directions(out);
  if (options.steady) out = steady_means(out);
  drop_constant_signals(out);
  drop_negligible_load(out);
  check_varying(out);
  check_sign(out, data.torques_flipped);
  return out;
}

}  // namespace tribench::loop
