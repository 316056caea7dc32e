// SPDX-License-Identifier: MIT
#include "problems/preparation/recording_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "problems/preparation/derived_channels.hpp"
#include "problems/preparation/segments.hpp"

namespace tribench {
namespace {

constexpr std::size_t kEnoughMovements = 15;
constexpr std::size_t kMostStrokes = 150;  // more say no more of independence
// Slower rows are near a rest: bristles that have not slid yet carry a part of the friction there.
constexpr double kSlow = 0.01;  // of the top speed
constexpr double kNoisy = 3;    // of the velocity's noise

// Strokes that follow one another without a rest, at most `together` of them.
std::vector<std::vector<RowRange>> grouped(const std::vector<RowRange>& strokes,
                                           const Dataset& data, std::span<const double> time,
                                           double longest, std::size_t together) {
  std::vector<std::vector<RowRange>> groups;
  for (const RowRange& stroke : strokes) {
    const bool fits = !groups.empty() && groups.back().size() < together &&
                      time[stroke.begin] - time[groups.back().back().end - 1] <= longest &&
                      data.movement[groups.back().back().begin] == data.movement[stroke.begin];
    if (fits) {
      groups.back().push_back(stroke);
    } else {
      groups.push_back({stroke});
    }
  }
  return groups;
}

// Movements: what lies between two rests, since strokes without one are not independent of each
// other; where those are too few to tell anything from, the strokes.
std::vector<std::vector<RowRange>> movements_of(const std::vector<RowRange>& strokes,
                                                const Dataset& data, std::span<const double> time,
                                                double longest) {
  std::vector<std::vector<RowRange>> between_rests =
      grouped(strokes, data, time, longest, strokes.size());
  if (between_rests.size() >= kEnoughMovements) return between_rests;
  return grouped(strokes, data, time, longest, (strokes.size() + kMostStrokes - 1) / kMostStrokes);
}

// Around a rest or a reversal a smoothed velocity says nothing for as long as the smoother sees:
// what friction does there would pass for an effect of slow speed.
std::vector<RowRange> without_ends(const std::vector<RowRange>& strokes,
                                   std::span<const double> time, double blur) {
  std::vector<RowRange> inner;
  for (RowRange stroke : strokes) {
    const double begin = time[stroke.begin] + blur;
    const double end = time[stroke.end - 1] - blur;
    while (stroke.begin < stroke.end && time[stroke.begin] < begin) ++stroke.begin;
    while (stroke.end > stroke.begin && time[stroke.end - 1] > end) --stroke.end;
    if (stroke.end - stroke.begin >= kFewestRows) inner.push_back(stroke);
  }
  return inner;
}

// The path since the direction last changed, told before a stroke's ends are cut off: the position
// knows it where the velocity is blurred. Lost messages do not make it start anew.
void add_distance(PreparedRecording& out, const std::vector<RowRange>& strokes) {
  constexpr double kForgotten = 0.5;  // s without a message: the joint may have turned
  const Channel* q = find_channel(out.data, Role::position);
  if (q == nullptr) return;
  const std::vector<double>& v = find_channel(out.data, Role::velocity)->values;
  const std::vector<double>& t = find_channel(out.data, Role::time)->values;
  Channel distance{std::string(loop::kDerivedDistance), q->unit, Role::none,
                   std::vector<double>(out.data.rows(), 0.0)};
  loop::DistanceSinceReversal path(loop::PathFrom::position);
  const RowRange* before = nullptr;
  for (const RowRange& stroke : strokes) {
    const std::size_t middle = stroke.begin + (stroke.end - stroke.begin) / 2;
    const bool goes_on = before != nullptr && before->end == stroke.begin &&
                         t[stroke.begin] - t[stroke.begin - 1] < kForgotten &&
                         v[middle] * v[before->begin + (before->end - before->begin) / 2] > 0;
    if (!goes_on) path.start_movement();
    for (std::size_t i = stroke.begin; i < stroke.end; ++i) {
      const double direction = v[middle] > 0 ? 1 : -1;  // of the stroke: noise at its ends is none
      distance.values[i] =
          path.next(direction, q->values[i], i > stroke.begin ? t[i] - t[i - 1] : 0);
    }
    before = &stroke;
  }
  out.data.channels.push_back(std::move(distance));
}

}  // namespace

void cut_strokes(PreparedRecording& out, double noise, double blur) {
  const Channel* t = find_channel(out.data, Role::time);
  const Channel* v = find_channel(out.data, Role::velocity);
  if (t == nullptr || v == nullptr || !is_regular(t->values, out.data.movement)) return;
  Strokes found = strokes_of(t->values, v->values, pieces_of(t->values, out.data.movement, {}),
                             noise, kFewestRows);
  add_distance(out, found.strokes);
  t = find_channel(out.data, Role::time);
  v = find_channel(out.data, Role::velocity);
  if (blur > 0) found.strokes = without_ends(found.strokes, t->values, blur);
  if (found.strokes.size() < 2) return;
  const double longest = 2 * blur + 3 * median_step(t->values, out.data.movement);
  const std::size_t all = out.data.rows();
  const std::size_t files = out.data.movement_names.size();
  const double slow = std::max(kSlow * top_speed(v->values), kNoisy * noise);
  std::vector<std::size_t> rows;
  std::vector<int> movement;
  std::vector<std::string> names;
  for (const std::vector<RowRange>& group :
       movements_of(found.strokes, out.data, t->values, longest)) {
    const std::size_t before = rows.size();
    for (const RowRange& stroke : group) {
      for (std::size_t i = stroke.begin; i < stroke.end; ++i) {
        if (std::abs(v->values[i]) >= slow) rows.push_back(i);
      }
    }
    if (rows.size() == before) continue;
    movement.resize(rows.size(), static_cast<int>(names.size()));
    const auto file = static_cast<std::size_t>(out.data.movement[group.front().begin]);
    names.push_back(
        files > 1 ? fmt::format("{}, stroke {}", out.data.movement_names[file], names.size() + 1)
                  : fmt::format("stroke {}", names.size() + 1));
  }
  keep_rows(out.data, rows);
  out.data.movement = std::move(movement);
  out.data.movement_names = std::move(names);
  out.notes.push_back(fmt::format(
      "no column names the movements: {} strokes between {} rests and {} reversals make {}; {:.0f} "
      "% of the rows, at rest, slower than {:.2g} {} or in shorter strokes, are left out",
      found.strokes.size(), found.rests, found.reversals, out.data.movement_names.size(),
      100.0 * static_cast<double>(all - out.data.rows()) / static_cast<double>(all), slow,
      find_channel(out.data, Role::velocity)->unit));
}

}  // namespace tribench
