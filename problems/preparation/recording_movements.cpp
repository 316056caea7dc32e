// SPDX-License-Identifier: MIT
#include "problems/preparation/recording_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "foundation/error.hpp"
#include "problems/preparation/derived_channels.hpp"
#include "problems/preparation/segments.hpp"
#include "problems/table.hpp"

namespace tribench {
namespace {

constexpr double kForgotten = 0.5;           // s without a message: the joint may have turned
constexpr std::size_t kEnoughMovements = 8;  // to leave some out in turn
constexpr std::size_t kMostStrokes = 150;    // more say no more of independence
// Slower rows, and nearer ones, are at a rest or a reversal: bristles that have not slid yet carry
// a part of the friction there, after a reversal twice all of it.
constexpr double kSlow = 0.02;       // of the top speed
constexpr double kNear = 4e-4;       // of the longest stroke's way
constexpr double kSomewhere = 0.01;  // of the longest stroke's way
constexpr double kNoisy = 3;         // of the velocity's noise
constexpr double kSamePlace = 1e-3;  // of the position's range

// The rows of each movement in turn, as they stand.
std::vector<RowRange> blocks_of(const Dataset& data) {
  std::vector<RowRange> blocks;
  for (std::size_t begin = 0, end = 0; begin < data.rows(); begin = end) {
    for (end = begin + 1; end < data.rows() && data.movement[end] == data.movement[begin];) ++end;
    blocks.push_back({begin, end});
  }
  return blocks;
}

// Whether no movement begins before the one above has ended: else each has a clock of its own.
bool is_one_clock(const Dataset& data) {
  const std::vector<double>& t = data.find(Role::time)->values;
  for (std::size_t i = 1; i < data.rows(); ++i) {
    if (data.movement[i] != data.movement[i - 1] && t[i] < t[i - 1]) return false;
  }
  return true;
}

// A stroke, and which of the stretches between two rests it belongs to.
struct ChainedStroke {
  RowRange rows;
  std::size_t chain = 0;
};

// Lost messages are no rest.
std::vector<ChainedStroke> chained(const std::vector<RowRange>& strokes, const Dataset& data,
                                   std::span<const double> time) {
  std::vector<ChainedStroke> out;
  for (const RowRange& stroke : strokes) {
    const bool goes_on = !out.empty() && out.back().rows.end == stroke.begin &&
                         time[stroke.begin] - time[stroke.begin - 1] < kForgotten &&
                         data.movement[stroke.begin] == data.movement[stroke.begin - 1];
    out.push_back({stroke, out.empty() ? 0 : out.back().chain + (goes_on ? 0 : 1)});
  }
  return out;
}

// Movements: what lies between two rests, since strokes without one are not independent of each
// other, and what one stroke at one speed shows is an offset of its own; where those are too few to
// tell anything from, the strokes.
std::vector<std::vector<RowRange>> movements_of(const std::vector<ChainedStroke>& strokes) {
  std::size_t chains = 0;
  for (std::size_t k = 0; k < strokes.size(); ++k) {
    chains += k == 0 || strokes[k].chain != strokes[k - 1].chain ? 1 : 0;
  }
  const std::size_t together = chains >= kEnoughMovements
                                   ? strokes.size()
                                   : (strokes.size() + kMostStrokes - 1) / kMostStrokes;
  std::vector<std::vector<RowRange>> groups;
  std::size_t chain = 0;
  for (const ChainedStroke& stroke : strokes) {
    if (!groups.empty() && groups.back().size() < together && stroke.chain == chain) {
      groups.back().push_back(stroke.rows);
    } else {
      groups.push_back({stroke.rows});
    }
    chain = stroke.chain;
  }
  return groups;
}

// Around a rest or a reversal a smoothed velocity says nothing for as long as the smoother sees:
// what friction does there would pass for an effect of slow speed.
std::vector<ChainedStroke> without_ends(const std::vector<ChainedStroke>& strokes,
                                        std::span<const double> time, double blur) {
  std::vector<ChainedStroke> inner;
  for (ChainedStroke stroke : strokes) {
    RowRange& rows = stroke.rows;
    const double begin = time[rows.begin] + blur;
    const double end = time[rows.end - 1] - blur;
    while (rows.begin < rows.end && time[rows.begin] < begin) ++rows.begin;
    while (rows.end > rows.begin && time[rows.end - 1] > end) --rows.end;
    if (rows.end - rows.begin >= kFewestRows) inner.push_back(stroke);
  }
  return inner;
}

bool starts_from_rest(const RowRange& stroke, const std::vector<double>& v, double standstill) {
  const std::size_t second = std::min(stroke.begin + 1, stroke.end - 1);
  return loop::starts_from_rest(v[stroke.begin], v[second], standstill);
}

bool knows_distance(const Dataset& data) {
  return std::ranges::any_of(data.channels, [](const Channel& channel) {
    return channel.name.starts_with("distance_since_reversal") ||
           channel.name == loop::derived_channel_name("d");
  });
}

// The path since the direction last changed, told before a stroke's ends are cut off: the position
// knows it where the velocity is blurred. Lost messages do not make it start anew. A reversal is
// seen where a stroke follows another or starts from standstill, but not where it goes on from
// where the last one the same way ended: bristles may stay bent over a rest. None where no reversal
// is seen: "distance" would be a name for the place within a recording.
void add_distance(PreparedRecording& out, const std::vector<RowRange>& strokes) {
  const Channel* q = find_channel(out.data, Role::position);
  if (q == nullptr || knows_distance(out.data)) return;
  const std::vector<double>& v = find_channel(out.data, Role::velocity)->values;
  const std::vector<double>& t = find_channel(out.data, Role::time)->values;
  Channel distance{loop::derived_channel_name("d"), q->unit, Role::none,
                   std::vector<double>(out.data.rows(), 0.0)};
  loop::DistanceSinceReversal path(loop::PathFrom::position);
  const auto [low, high] = std::ranges::minmax(q->values);
  const bool one_clock = is_one_clock(out.data);
  const auto follows_on = [&](const RowRange& stroke, const RowRange& last) {
    const bool one_movement = out.data.movement[stroke.begin] == out.data.movement[last.begin];
    return (one_movement ? last.end == stroke.begin : one_clock) &&
           t[stroke.begin] - t[last.end - 1] < kForgotten;
  };
  const RowRange* before = nullptr;
  std::vector<char> seen(out.data.rows(), 1);
  for (const RowRange& stroke : strokes) {
    const std::size_t middle = stroke.begin + (stroke.end - stroke.begin) / 2;
    const bool follows = before != nullptr && follows_on(stroke, *before);
    const bool same_way =
        before != nullptr && v[middle] * v[before->begin + (before->end - before->begin) / 2] > 0;
    const bool goes_on = follows && same_way;
    if (!goes_on) path.start_movement();
    const bool turned =
        follows || starts_from_rest(stroke, v, loop::kStandstill * std::abs(v[middle]));
    const bool still_bent =
        same_way &&
        std::abs(q->values[stroke.begin] - q->values[before->end - 1]) < kSamePlace * (high - low);
    const bool is_seen = goes_on ? seen[before->end - 1] != 0 : turned && !still_bent;
    std::fill(seen.begin() + static_cast<std::ptrdiff_t>(stroke.begin),
              seen.begin() + static_cast<std::ptrdiff_t>(stroke.end), is_seen ? char{1} : char{0});
    for (std::size_t i = stroke.begin; i < stroke.end; ++i) {
      const double direction = v[middle] > 0 ? 1 : -1;  // of the stroke: noise at its ends is none
      distance.values[i] =
          path.next(direction, q->values[i], i > stroke.begin ? t[i] - t[i - 1] : 0);
    }
    before = &stroke;
  }
  const bool any_seen =
      std::ranges::any_of(strokes, [&](const RowRange& stroke) { return seen[stroke.begin] != 0; });
  if (!any_seen) return;
  out.data.channels.push_back(distance);
  distance.values = loop::seen_distance(std::move(distance.values), seen);
  if (distance.values.empty()) return;
  distance.name = loop::derived_channel_name(loop::kSeenDistance);
  out.data.channels.push_back(std::move(distance));
}

// The velocities that late friction follows, told before rows are cut: what is slow is where they
// differ from the velocity most.
void add_late_channels(PreparedRecording& out) {
  if (find_channel(out.data, Role::acceleration) == nullptr) return;
  const Channel v = *find_channel(out.data, Role::velocity);
  const std::vector<double> time = find_channel(out.data, Role::time)->values;
  for (const loop::LateChannel& late : loop::LateChannel::all()) {
    out.data.channels.push_back(
        {loop::derived_channel_name(late.name()), late.unit(v.unit), Role::none,
         late.values(v.values, time, out.data.movement, loop::MovementOrder::told)});
  }
}

// A movement is slow or fast by itself: what creeps all along is not at rest.
std::vector<RowRange> strokes_of_movements(const Dataset& data, const Channel& t, const Channel& v,
                                           double noise) {
  std::vector<RowRange> strokes;
  for (const RowRange& block : blocks_of(data)) {
    const auto time = std::span(t.values).subspan(block.begin, block.end - block.begin);
    const auto movement = std::span(data.movement).subspan(block.begin, block.end - block.begin);
    const Strokes found =
        strokes_of(time, std::span(v.values).subspan(block.begin, block.end - block.begin),
                   pieces_of(time, movement, {}), noise, 1);
    for (const RowRange& stroke : found.strokes) {
      strokes.push_back({block.begin + stroke.begin, block.begin + stroke.end});
    }
  }
  return strokes;
}

// What is slow or near a reversal, and how far a stroke has to get that is slow all along to be
// near no rest.
struct Slow {
  double speed = 0;
  double rest = 0;  // slower still: at rest
  double near = 0;
  double way = 0;

  Slow(const std::vector<RowRange>& strokes, const std::vector<double>& t,
       const std::vector<double>& v, double noise)
      : speed(std::max(kSlow * top_speed(v), kNoisy * noise)), rest(rest_speed(v, noise)) {
    double longest = 0;
    for (const RowRange& stroke : strokes) longest = std::max(longest, way_of(stroke, t, v));
    near = kNear * longest;
    way = kSomewhere * longest;
  }

  static double way_of(const RowRange& stroke, const std::vector<double>& t,
                       const std::vector<double>& v) {
    double sum = 0;
    for (std::size_t i = stroke.begin + 1; i < stroke.end; ++i) {
      sum += std::abs(v[i]) * (t[i] - t[i - 1]);
    }
    return sum;
  }
};

std::string in_words(const Slow& slow, const Dataset& data) {
  std::string words =
      fmt::format("slower than {:.2g} {}", slow.speed, data.find(Role::velocity)->unit);
  if (const Channel* d = data.find(loop::derived_channel_name("d")); d != nullptr) {
    words += fmt::format(", nearer than {:.2g} {} to a reversal", slow.near, d->unit);
  }
  return words;
}

// The slow stretches in which a stroke begins, ends, or stops and goes on the same way: a stop too
// short to end a stroke holds what friction does at rest all the same.
std::vector<char> rows_near_rests(RowRange stroke, const Slow& slow, const std::vector<double>& v) {
  std::vector<char> near_rest(stroke.end - stroke.begin, 0);
  for (std::size_t begin = stroke.begin; begin < stroke.end;) {
    std::size_t end = begin;
    bool stops = false;
    for (; end < stroke.end && std::abs(v[end]) < slow.speed; ++end) {
      stops = stops || std::abs(v[end]) < slow.rest;
    }
    if (stops || begin == stroke.begin || end == stroke.end) {
      std::fill(near_rest.begin() + static_cast<std::ptrdiff_t>(begin - stroke.begin),
                near_rest.begin() + static_cast<std::ptrdiff_t>(end - stroke.begin), 1);
    }
    begin = std::max(end, begin + 1);
  }
  return near_rest;
}

// A stroke's rows where it moves; all of a stroke that creeps from one place to another, but for
// rows as slow as the noise; and none so near a reversal.
void add_moving(std::vector<std::size_t>& rows, RowRange stroke, const Slow& slow,
                const Dataset& data, double noise) {
  const std::vector<double>& t = data.find(Role::time)->values;
  const std::vector<double>& v = data.find(Role::velocity)->values;
  const Channel* d = data.find(loop::derived_channel_name("d"));  // null: nobody knows it
  std::vector<char> near_rest = rows_near_rests(stroke, slow, v);
  const bool creeps =
      std::ranges::count(near_rest, 0) == 0 && Slow::way_of(stroke, t, v) > slow.way;
  if (creeps) std::ranges::fill(near_rest, 0);
  for (std::size_t i = stroke.begin; i < stroke.end; ++i) {
    const bool moves = near_rest[i - stroke.begin] == 0 && std::abs(v[i]) >= kNoisy * noise;
    const bool turns = d != nullptr && d->values[i] < slow.near;
    if (moves && !turns) rows.push_back(i);
  }
}

}  // namespace

void sort_movements(PreparedRecording& out) {
  const Channel* time = find_channel(out.data, Role::time);
  if (time == nullptr) return;
  const std::vector<double>& t = time->values;
  const auto begin_of = [&](const RowRange& block) { return t[block.begin]; };
  std::vector<RowRange> blocks = blocks_of(out.data);
  if (std::ranges::is_sorted(blocks, {}, begin_of)) return;
  std::ranges::stable_sort(blocks, {}, begin_of);
  for (std::size_t k = 1; k < blocks.size(); ++k) {
    if (t[blocks[k].begin] < t[blocks[k - 1].end - 1]) return;
  }
  std::vector<std::size_t> rows;
  std::vector<std::string> names;
  std::vector<int> renamed(out.data.movement_names.size(), -1);
  for (const RowRange& block : blocks) {
    for (std::size_t i = block.begin; i < block.end; ++i) rows.push_back(i);
    int& name = renamed[static_cast<std::size_t>(out.data.movement[block.begin])];
    if (name >= 0) continue;
    name = static_cast<int>(names.size());
    names.push_back(
        out.data.movement_names[static_cast<std::size_t>(out.data.movement[block.begin])]);
  }
  std::vector<TextCell> texts = std::move(out.data.texts);
  out.data = select_rows({std::move(out.data), {}}, rows).data;
  out.data.texts = std::move(texts);
  for (int& movement : out.data.movement) movement = renamed[static_cast<std::size_t>(movement)];
  out.data.movement_names = std::move(names);
}

void cut_strokes(PreparedRecording& out, double noise, double blur) {
  const Channel* t = find_channel(out.data, Role::time);
  const Channel* v = find_channel(out.data, Role::velocity);
  if (t == nullptr || v == nullptr || !is_regular(t->values, out.data.movement)) return;
  const Strokes found = strokes_of(t->values, v->values,
                                   pieces_of(t->values, out.data.movement, {}), noise, kFewestRows);
  add_distance(out, found.strokes);
  add_late_channels(out);
  t = find_channel(out.data, Role::time);
  v = find_channel(out.data, Role::velocity);
  const std::vector<ChainedStroke> strokes =
      without_ends(chained(found.strokes, out.data, t->values), t->values, blur);
  if (strokes.size() < 2) return;
  const std::size_t all = out.data.rows();
  const std::size_t files = out.data.movement_names.size();
  const Slow slow(found.strokes, t->values, v->values, noise);
  std::vector<std::size_t> rows;
  std::vector<int> movement;
  std::vector<std::string> names;
  for (const std::vector<RowRange>& group : movements_of(strokes)) {
    const std::size_t before = rows.size();
    for (const RowRange& stroke : group) add_moving(rows, stroke, slow, out.data, noise);
    if (rows.size() == before) continue;
    movement.resize(rows.size(), static_cast<int>(names.size()));
    const auto file = static_cast<std::size_t>(out.data.movement[group.front().begin]);
    names.push_back(
        files > 1 ? fmt::format("{}, stroke {}", out.data.movement_names[file], names.size() + 1)
                  : fmt::format("stroke {}", names.size() + 1));
  }
  if (rows.empty()) {
    throw_bad_input(fmt::format("none of {} rows moves at {:.2g} {} or more for long enough", all,
                                slow.speed, find_channel(out.data, Role::velocity)->unit),
                    out.data.name,
                    "check what was taken for position, velocity and time: --explain");
  }
  keep_rows(out.data, rows);
  out.data.movement = std::move(movement);
  out.data.movement_names = std::move(names);
  out.notes.push_back(fmt::format(
      "no column names the movements: {} strokes between {} rests and {} reversals make {}; {:.0f} "
      "% of the rows, at rest, {} or in shorter strokes, are left out",
      strokes.size(), found.rests, found.reversals, out.data.movement_names.size(),
      100.0 * static_cast<double>(all - out.data.rows()) / static_cast<double>(all),
      in_words(slow, out.data)));
}

void settle_strokes(PreparedRecording& out, double noise) {
  const Channel* t = find_channel(out.data, Role::time);
  const Channel* v = find_channel(out.data, Role::velocity);
  if (t == nullptr || v == nullptr || !is_regular(t->values, out.data.movement)) return;
  const std::vector<RowRange> strokes = strokes_of_movements(out.data, *t, *v, noise);
  Slow slow(strokes, t->values, v->values, noise);
  slow.way = 0;  // somebody has told them apart: each small stroke is wanted
  add_distance(out, strokes);
  std::vector<std::size_t> rows;
  for (const RowRange& stroke : strokes) add_moving(rows, stroke, slow, out.data, noise);
  if (rows.empty() || rows.size() == out.data.rows()) return;
  add_late_channels(out);
  const std::size_t all = out.data.rows();
  keep_rows(out.data, rows);
  out.notes.push_back(
      fmt::format("{} of {} rows, at rest, {}, where bristles may not slide yet: left out",
                  all - rows.size(), all, in_words(slow, out.data)));
}

}  // namespace tribench
