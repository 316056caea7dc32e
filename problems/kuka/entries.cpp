// SPDX-License-Identifier: MIT
#include "problems/kuka/entries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "foundation/random.hpp"
#include "problems/kuka/campaign.hpp"
#include "problems/table.hpp"

namespace tribench::kuka {
namespace {

constexpr std::size_t kTrainRows = 40;    // a movement of A
constexpr std::size_t kTestRows = 200;    // a movement of A
constexpr std::size_t kAdaptRows = 2000;  // of B's one movement
constexpr std::size_t kTestRowsB = 400;   // a movement of B
constexpr int kTestMovementsB = 10;
constexpr int kSpeedBands = 5;
// B's posture factor reaches 1.08, see campaign.cpp.
constexpr double kLargestPostureFactor = 1.08;

RandomStream stream_of(int joint, std::uint64_t seed) {
  return RandomStream(key_of(fmt::format("kuka/j{}/problem", joint))).split(seed);
}

// Marks the 10 test movements of A: one of each band of 9 speeds in either direction.
std::vector<char> test_movements(const Joint& joint, std::uint64_t seed) {
  const std::vector<Setting> settings = campaign_order(joint, seed);
  RandomStream random = stream_of(joint.number, seed).split("split");
  std::vector<char> test(settings.size(), 0);
  for (const int direction : {1, -1}) {
    for (int band = 0; band < kSpeedBands; ++band) {
      constexpr int kWidth = kSpeeds / kSpeedBands;
      const int speed = band * kWidth + static_cast<int>(random.below(kWidth));
      for (std::size_t m = 0; m < settings.size(); ++m) {
        if (settings[m].speed == speed && settings[m].direction == direction) test[m] = 1;
      }
    }
  }
  return test;
}

std::vector<char> complement(std::vector<char> take) {
  for (char& mark : take) mark = mark == 0 ? 1 : 0;
  return take;
}

std::vector<Input> velocity_inputs() {
  std::vector<Input> inputs = {{"qd", "rad/s", Role::velocity, -kFastest_rad_s, kFastest_rad_s, {}},
                               {"sgn_qd", "-", Role::velocity_sign, -1, 1, {}}};
  link_signs(inputs);
  return inputs;
}

std::vector<Input> load_inputs(double largest_gravity_nm) {
  std::vector<Input> inputs = velocity_inputs();
  inputs.push_back({"g", "N m", Role::gravity_torque, -largest_gravity_nm, largest_gravity_nm, {}});
  inputs.push_back({"sgn_g", "-", Role::gravity_sign, -1, 1, {}});
  link_signs(inputs);
  return inputs;
}

Problem blank(const std::string& name, std::string dataset, int joint, bool load) {
  return {.name = name,
          .summary = {},
          .dataset = std::move(dataset),
          .joint = joint,
          .load = load,
          .target = "tau_f",
          .target_unit = "N m",
          .inputs = {},
          .stages = {},
          .test = {}};
}

Problem make_averaged_problem(const std::string& name, int number, std::uint64_t seed) {
  const Joint joint = make_joint(number, seed);
  const KnownDataset data = make_a_averaged(joint, seed);
  const std::vector<char> test = test_movements(joint, seed);
  Problem problem = blank(name, "A", number, false);
  problem.inputs = velocity_inputs();
  problem.stages.push_back({"fit",
                            {0, 1},
                            make_table(data, problem.inputs, "tau_f", complement(test)),
                            joint.law.formula(false, joint.mean_ripple_nm())});
  problem.test = make_table(data, problem.inputs, "tau_f", test);
  return problem;
}

// The training rows of A with load, for inputs that may reach beyond A's.
Table load_training(const Joint& joint, std::uint64_t seed, const KnownDataset& raw,
                    std::span<const Input> inputs) {
  const KnownDataset thinned =
      thin(raw, kTrainRows, stream_of(joint.number, seed).split("train rows"));
  return make_table(thinned, inputs, "tau_f", complement(test_movements(joint, seed)));
}

Problem make_load_problem(const std::string& name, int number, std::uint64_t seed) {
  const Joint joint = make_joint(number, seed);
  const KnownDataset raw = make_a_raw(joint, seed, kTestRows);
  Problem problem = blank(name, "A", number, true);
  problem.inputs = load_inputs(joint.gravity_amplitude_nm);
  problem.stages.push_back({"fit",
                            {0, 1, 2, 3},
                            load_training(joint, seed, raw, problem.inputs),
                            joint.law.formula(true)});
  problem.test = make_table(raw, problem.inputs, "tau_f", test_movements(joint, seed));
  return problem;
}

// Raw A with every channel; the truth has no ripple, as for A/jN/load.
Problem make_channels_problem(const std::string& name, int number, std::uint64_t seed) {
  const Joint joint = make_joint(number, seed);
  const KnownDataset raw = make_a_raw(joint, seed, kTestRows);
  Problem problem = blank(name, "A", number, true);
  problem.inputs = load_inputs(joint.gravity_amplitude_nm);
  problem.inputs.push_back({"q", "rad", Role::position, -kStrokeEnd_rad, kStrokeEnd_rad, {}});
  problem.inputs.push_back({"time_s", "s", Role::time, 0, raw.data.at("time_s").values.back(), {}});
  problem.stages.push_back({"fit",
                            {0, 1, 2, 3, 4, 5},
                            load_training(joint, seed, raw, problem.inputs),
                            joint.law.formula(true)});
  problem.test = make_table(raw, problem.inputs, "tau_f", test_movements(joint, seed));
  return problem;
}

Problem make_b_problem(const std::string& name, int number, bool load, bool adapted,
                       std::uint64_t seed) {
  const Joint joint = make_joint(number, seed);
  Problem problem = blank(name, "B", number, load);
  const double payload_nm = kStandardGravity * kPayload_kg * joint.payload_lever_m;
  problem.inputs =
      load_inputs(kLargestPostureFactor * (joint.gravity_amplitude_nm + (load ? payload_nm : 0)));
  problem.stages.push_back(
      {"fit",
       {0, 1, 2, 3},
       load_training(joint, seed, make_a_raw(joint, seed, kTestRows), problem.inputs),
       joint.law.formula(true)});
  const std::vector<char> one = {1};
  if (adapted) {
    const KnownDataset movement = make_adaptation_movement(joint, seed);
    problem.stages.push_back({"adapt",
                              {1, 2, 3},
                              make_table(movement, problem.inputs, "tau_f", one),
                              joint.shift_formula()});
  }
  const KnownDataset test = make_b_test(joint, seed, load);
  const std::vector<char> all(test.data.movement_names.size(), 1);
  problem.test = make_table(test, problem.inputs, "tau_f", all);
  return problem;
}

// The whole campaign with all channels, for `generate` and for the loop.
Dataset campaign_rows(const Joint& joint, std::uint64_t seed) {
  return thin(make_a_raw(joint, seed, kTestRows), kTrainRows,
              stream_of(joint.number, seed).split("train rows"))
      .data;
}

void add_entry(std::vector<ProblemEntry>& entries, std::string name, std::string summary,
               std::function<Problem(const std::string&, std::uint64_t)> make,
               std::function<Dataset(std::uint64_t)> data) {
  auto complete = [name, summary, make = std::move(make)](std::uint64_t seed) {
    Problem problem = make(name, seed);
    problem.summary = summary;
    return problem;
  };
  entries.push_back({std::move(name), std::move(summary), std::move(complete), std::move(data)});
}

void add_a(std::vector<ProblemEntry>& entries, int joint) {
  add_entry(
      entries, fmt::format("A/j{}/no_load", joint),
      fmt::format("joint {}: friction averaged over the load, from velocity", joint),
      [joint](const std::string& name, std::uint64_t seed) {
        return make_averaged_problem(name, joint, seed);
      },
      [joint](std::uint64_t seed) { return make_a_averaged(make_joint(joint, seed), seed).data; });
  add_entry(
      entries, fmt::format("A/j{}/load", joint),
      fmt::format("joint {}: raw friction, from velocity and gravity torque", joint),
      [joint](const std::string& name, std::uint64_t seed) {
        return make_load_problem(name, joint, seed);
      },
      [joint](std::uint64_t seed) { return campaign_rows(make_joint(joint, seed), seed); });
  add_entry(
      entries, fmt::format("A/j{}/channels", joint),
      fmt::format("joint {}: raw friction, every channel as an input", joint),
      [joint](const std::string& name, std::uint64_t seed) {
        return make_channels_problem(name, joint, seed);
      },
      [joint](std::uint64_t seed) { return campaign_rows(make_joint(joint, seed), seed); });
}

void add_b(std::vector<ProblemEntry>& entries, int joint, bool load, bool adapted) {
  const char* place = load ? "load" : "no_load";
  const std::string tested = load ? fmt::format("with {} kg", kPayload_kg) : "without load";
  add_entry(
      entries, fmt::format("B/j{}/{}{}", joint, place, adapted ? "" : "/unadapted"),
      adapted
          ? fmt::format("joint {}: A's law adapted on one movement, tested on B {}", joint, tested)
          : fmt::format("joint {}: A's law as it is, tested on B {}", joint, tested),
      [joint, load, adapted](const std::string& name, std::uint64_t seed) {
        return make_b_problem(name, joint, load, adapted, seed);
      },
      [joint, load](std::uint64_t seed) {
        return make_b_test(make_joint(joint, seed), seed, load).data;
      });
}

}  // namespace

KnownDataset make_adaptation_movement(const Joint& joint, std::uint64_t seed) {
  return make_b(joint, seed, 0, 1, kAdaptRows);
}

// The first unloaded movement is the adaptation's, and is left out here.
KnownDataset make_b_test(const Joint& joint, std::uint64_t seed, bool load) {
  const KnownDataset all =
      make_b(joint, seed, load ? kPayload_kg : 0, kTestMovementsB + 1, kTestRowsB);
  std::vector<std::size_t> rows;
  for (std::size_t r = kTestRowsB; r < all.data.rows(); ++r) rows.push_back(r);
  KnownDataset test = select_rows(all, rows);
  test.data.movement_names.erase(test.data.movement_names.begin());
  for (int& movement : test.data.movement) --movement;
  return test;
}

void add_entries(std::vector<ProblemEntry>& entries) {
  for (const int joint : {2, 4}) add_a(entries, joint);
  for (const int joint : {2, 4}) {
    for (const bool adapted : {true, false}) {
      add_b(entries, joint, false, adapted);
      add_b(entries, joint, true, adapted);
    }
  }
}

}  // namespace tribench::kuka
