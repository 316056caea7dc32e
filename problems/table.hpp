// SPDX-License-Identifier: MIT
//
// From a dataset with channels to the tables that methods and the judge see. Not for recordings
// that a diagnosis looks at: their rows are chosen by what a motion tells
// (preparation/recording.hpp).
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "foundation/random.hpp"
#include "problems/dataset.hpp"
#include "problems/problem.hpp"

namespace tribench {

// A dataset together with the noise-free value of its target, row by row; empty where unknown.
struct KnownDataset {
  Dataset data;
  std::vector<double> truth;
};

// The values of input `name`: the channel of that name, or, for a missing sgn_X, the sign of
// channel X (0 at 0). Throws Error (bad_input) with the nearest name.
std::vector<double> input_values(const ChannelIndex& channels, std::string_view name);

// Throws Error (bad_input) where X and sgn_X are inputs and a channel sgn_X is not the sign of X:
// a fit would use the channel, and proofs and exported code the sign.
void require_signs(const Dataset& data, std::span<const std::string> inputs);

// Fills sign_of wherever an input is named sgn_X and X is among the inputs.
void link_signs(std::vector<Input>& inputs);

// Rows of the movements with take[movement] != 0, in the dataset's order; the movement numbers are
// the dataset's. Where there is a channel of time, the table has a trail: all rows of the dataset.
Table make_table(const KnownDataset& source, std::span<const Input> inputs, std::string_view target,
                 std::span<const char> take);

// Puts the trail of a whole recording in the place of the one that the table has, which was made of
// rows drawn from it (`thin`). Without a channel of time nothing happens.
void lay_trail(const Dataset& recording, const Dataset& drawn, std::span<const Input> inputs,
               Table& table);

// Where time breaks: rows where it does not grow or leaps by more than five median steps.
std::vector<std::size_t> run_starts(std::span<const double> time);

// Marks a share of the movements (at least one, never all where there are two) for testing: drawn
// from strata of direction and mean speed where there is a velocity, so that the test covers the
// range that the training rows cover.
std::vector<char> draw_test_movements(const Dataset& data, double share, RandomStream random);

// The rows at the given places, which must increase.
KnownDataset select_rows(const KnownDataset& source, std::span<const std::size_t> rows);

// The values at the given places, in that order; nothing of nothing.
template <typename T>
std::vector<T> at_rows(const std::vector<T>& values, std::span<const std::size_t> rows) {
  std::vector<T> taken;
  if (values.empty()) return taken;
  for (const std::size_t r : rows) taken.push_back(values[r]);
  return taken;
}

// The rows at the given places, in that order; one may be named again. The trail stays whole.
Table select_rows(const Table& table, std::span<const std::size_t> rows);

// The same number of rows of every movement: each movement is cut into per_movement equal runs of
// rows and one row is drawn from each. Movements with fewer rows are kept whole.
KnownDataset thin(const KnownDataset& source, std::size_t per_movement, const RandomStream& random);

// The rows of the problem's tables as a recording: the last stage's training rows, then the test
// rows, with the inputs and the target as channels. For problems without a recording of their own.
Dataset dataset_of_tables(const Problem& problem);

}  // namespace tribench
