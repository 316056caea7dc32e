// SPDX-License-Identifier: MIT
//
// A data file as the closed loop takes it, from its text to the rows that a diagnosis looks at:
// refused with a place, or finite numbers in every channel, whatever the user said of it. What is
// said stands in the first line, as behind --roles and --where ("q=position[deg] | joint=1"), the
// file in the rest.
#include <cmath>

#include "foundation/text.hpp"
#include "problems/preparation/observations.hpp"
#include "problems/preparation/recording.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace {

using namespace tribench;

constexpr std::size_t kMostRowsSmoothed = 300;  // smoothing more is no fault, but takes long

void try_recording(std::string_view roles, std::string_view text, Gravity gravity, bool all_known) {
  DataOptions options;
  CsvOptions reading;
  options.roles = reading.roles = parse_roles(roles, "--roles");
  options.drop_missing = reading.drop_missing = all_known;
  if (all_known) {
    options.drive.counts_per_turn = reading.drive.counts_per_turn = 4096;
    options.drive.gear_ratio = reading.drive.gear_ratio = 100;
    options.torque_constant = TorqueConstant{0.1, true};
    options.joint = reading.joint = 1;
  }
  DataFile file = parse_csv(text, "data.csv", reading);
  if (file.data.rows() > kMostRowsSmoothed) return;
  make_torque(file.data, options);
  const PreparedRecording prepared = prepare(std::move(file), options, gravity);
  for (const Channel& channel : prepared.data.channels) {
    fuzz::expect(channel.values.size() == prepared.data.rows(), "a channel has other rows");
    for (const double x : channel.values) fuzz::expect(std::isfinite(x), "a number is not finite");
  }
  loop::observe(prepared.data);
}

}  // namespace

TRIBENCH_FUZZ_TARGET(recording) {
  const std::size_t end = std::min(input.find('\n'), input.size());
  const std::string_view roles = input.substr(0, end);
  const std::string_view text = input.substr(std::min(end + 1, input.size()));
  fuzz::reads([&] { try_recording(roles, text, Gravity::automatic, false); });
  fuzz::reads([&] { try_recording(roles, text, Gravity::fit, true); });
}
