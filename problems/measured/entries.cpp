// SPDX-License-Identifier: MIT
#include "problems/measured/entries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "foundation/error.hpp"
#include "foundation/random.hpp"
#include "problems/data_problem.hpp"
#include "problems/file_hash.hpp"
#include "problems/measured/data_folder.hpp"
#include "problems/measured/recording.hpp"
#include "problems/table.hpp"

namespace tribench::measured {
namespace {

namespace fs = std::filesystem;
using DataFolder = std::optional<fs::path>;

fs::path verified_file(const Manifest& manifest, const std::string& name, const DataFolder& data) {
  const DataFolder folder = find_data_folder(data);
  if (!folder) {
    throw_bad_input(fmt::format("the measured set '{}' is not here", manifest.name), {},
                    "give its folder by --data DIR, $TRIBENCH_DATA or ./data; see: tribench data "
                    "list");
  }
  const fs::path path = *folder / manifest.name / name;
  const auto file = std::find_if(manifest.files.begin(), manifest.files.end(),
                                 [&name](const File& known) { return known.name == name; });
  if (file == manifest.files.end()) {
    throw Error(ErrorKind::failed, fmt::format("the manifest has no file '{}'", name),
                manifest.name);
  }
  std::error_code code;
  if (!fs::is_regular_file(path, code)) {
    throw_bad_input("the file is not there", path.string(),
                    fmt::format("get it from {}", manifest.source));
  }
  if (const std::string hash = sha256_of(path); hash != file->sha256) {
    throw_bad_input(fmt::format("the file has changed (SHA-256 {})", hash), path.string(),
                    fmt::format("get it again from {}", manifest.source));
  }
  return path;
}

// What a formula with memory has seen is the whole recording, not the rows drawn from it.
void lay_trails(const Dataset& recording, const Dataset& drawn, Problem& problem) {
  for (Stage& stage : problem.stages) lay_trail(recording, drawn, problem.inputs, stage.train);
}

Dataset thinned(const Dataset& data, const ProblemPlan& plan) {
  if (plan.rows_per_movement == 0) return data;
  return thin({data, {}}, plan.rows_per_movement, RandomStream(key_of(plan.name))).data;
}

// The test movements row by row, whatever the problem's tables keep of them.
MotionCase motion_case(const Manifest& manifest, const ProblemPlan& plan, const DataFolder& data,
                       const std::vector<char>& test) {
  ProblemPlan whole = plan;
  whole.decimate = 1;
  whole.average = false;
  const std::string& file = plan.test_file.empty() ? plan.file : plan.test_file;
  const Dataset rows = read_recording(whole, verified_file(manifest, file, data));
  std::vector<std::size_t> kept;
  for (std::size_t r = 0; r < rows.rows(); ++r) {
    if (test.empty() || test[static_cast<std::size_t>(rows.movement[r])] != 0) kept.push_back(r);
  }
  return {select_rows({rows, {}}, kept).data, *plan.motion};
}

}  // namespace

Problem make_measured_problem(const Manifest& manifest, const ProblemPlan& plan,
                              const DataFolder& data, std::uint64_t seed) {
  const Dataset whole = read_recording(plan, verified_file(manifest, plan.file, data));
  const Dataset recording = thinned(whole, plan);
  std::optional<Dataset> whole_other;
  std::optional<Dataset> other;
  if (!plan.test_file.empty()) {
    whole_other = read_recording(plan, verified_file(manifest, plan.test_file, data));
    other = thinned(*whole_other, plan);
  }
  Problem problem =
      make_data_problem(recording, other ? &*other : nullptr, plan.target, plan.inputs);
  problem.name = plan.name;
  problem.summary = plan.summary;
  problem.dataset = manifest.name;
  problem.joint = plan.joint;
  problem.load = plan.load;
  if (!other) {
    const std::vector<char> test = draw_test_movements(
        recording, plan.test_share, RandomStream(key_of(plan.name)).split(seed).split("split"));
    std::vector<char> train(test);
    for (char& mark : train) mark = mark == 0 ? 1 : 0;
    problem.stages.front().train = make_table({recording, {}}, problem.inputs, plan.target, train);
    problem.test = make_table({recording, {}}, problem.inputs, plan.target, test);
    lay_trails(whole, recording, problem);
    lay_trail(whole, recording, problem.inputs, problem.test);
    if (plan.motion) {
      problem.motion = [=] { return motion_case(manifest, plan, data, test); };
    }
    return problem;
  }
  lay_trails(whole, recording, problem);
  lay_trail(*whole_other, *other, problem.inputs, problem.test);
  if (plan.motion) {
    problem.motion = [=] { return motion_case(manifest, plan, data, {}); };
  }
  return problem;
}

void add_entries(std::vector<ProblemEntry>& entries, const DataFolder& data) {
  for (Manifest& known : known_manifests(data)) {
    const auto manifest = std::make_shared<const Manifest>(std::move(known));
    const std::string source =
        fmt::format("{}; {}; licence: {}", manifest->title, manifest->source, manifest->licence);
    for (const ProblemPlan& plan : manifest->problems) {
      entries.push_back({plan.name, plan.summary,
                         [manifest, &plan, data](std::uint64_t seed) {
                           return make_measured_problem(*manifest, plan, data, seed);
                         },
                         [manifest, &plan, data](std::uint64_t) {
                           return read_recording(plan, verified_file(*manifest, plan.file, data));
                         },
                         source});
    }
  }
}

}  // namespace tribench::measured
