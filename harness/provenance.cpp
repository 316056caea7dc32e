// SPDX-License-Identifier: MIT
#include "harness/provenance.hpp"

#include <fmt/format.h>
#include <Eigen/Core>

#include <nlopt.h>
#include <CLI/Version.hpp>
#include <algorithm>
#include <ctime>
#include <nlohmann/json.hpp>
#include <sstream>

#include "foundation/json_text.hpp"
#include "foundation/output_file.hpp"
#include "foundation/random.hpp"
#include "foundation/text.hpp"
#include "harness/build_info.hpp"
#include "harness/machine.hpp"
#include "problems/user/user_problem_text.hpp"

namespace tribench {
namespace {

using nlohmann::ordered_json;

ordered_json libraries_json() {
  int major = 0;
  int minor = 0;
  int patch = 0;
  nlopt_version(&major, &minor, &patch);
  return {{"eigen",
           fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
          {"nlopt", fmt::format("{}.{}.{}", major, minor, patch)},
          {"fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100,
                              FMT_VERSION % 100)},
          {"nlohmann_json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR,
                                        NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH)},
          {"cli11", CLI11_VERSION}};
}

ordered_json code_json() {
  const BuildInfo build = build_info();
  return {{"version", build.version},     {"commit", build.commit},
          {"dirty", build.is_dirty},      {"compiler", build.compiler},
          {"flags", build.flags},         {"build_type", build.build_type},
          {"libraries", libraries_json()}};
}

ordered_json machine_json() {
  const Machine machine = describe_machine();
  return {{"host", machine.host},         {"system", machine.system},
          {"cpu", machine.cpu},           {"processors", machine.processors},
          {"governor", machine.governor}, {"memory_mib", machine.memory_mib}};
}

ordered_json calibration_json(const std::vector<CalibrationSample>& samples) {
  ordered_json list = ordered_json::array();
  for (const CalibrationSample& sample : samples) {
    list.push_back({{"at_s", sample.at_s}, {"cpu_s", sample.cpu_s}, {"wall_s", sample.wall_s}});
  }
  return {{"drift", calibration_drift(samples)}, {"samples", list}};
}

ordered_json session_json(const RunSession& session) {
  const RunTally& tally = session.tally;
  const double utilisation = tally.fit_wall_s > 0 ? tally.fit_cpu_s / tally.fit_wall_s : 1;
  return {{"started", session.started},
          {"ended", session.ended},
          {"command_line", session.command_line},
          {"machine", machine_json()},
          {"jobs", session.options.jobs},
          {"pinned", session.options.pin},
          {"shard", fmt::format("{}/{}", session.options.shard.index, session.options.shard.count)},
          {"cells_of_shard", tally.cells},
          {"cells_run", tally.ran},
          {"retries", tally.retries},
          {"workers_started", tally.workers},
          {"stopped", tally.stopped},
          {"wall_s", tally.wall_s},
          {"fit_cpu_s", tally.fit_cpu_s},
          {"fit_wall_s", tally.fit_wall_s},
          {"utilisation", utilisation},
          {"contended_cells", tally.contended},
          {"calibration", calibration_json(tally.calibration)},
          {"journal_damage", tally.journal_damage}};
}

// The sessions of a folder so far; none where there are none or the file is damaged.
ordered_json earlier_sessions(const std::filesystem::path& file) {
  const ordered_json before = read_json<ordered_json>(read_file_if_there(file).value_or(""));
  if (!before.is_object() || !before.contains("sessions")) return ordered_json::array();
  return before.at("sessions");
}

// The files of the grid's own problems.
ordered_json files_json(const RunIdentity& identity) {
  ordered_json files = ordered_json::array();
  for (const user::UserProblem& own : user::parse_user_problems(identity.grid, "grid.toml", {})) {
    for (const auto& [sources, part] :
         {std::pair{&own.files, "rows"}, std::pair{&own.held_out.files, "test"}}) {
      for (const user::DataSource& source : *sources) {
        files.push_back({{"problem", own.name},
                         {"file", source.file.string()},
                         {"part", part},
                         {"sha256", source.sha256}});
      }
    }
  }
  return files;
}

void write_all(const std::filesystem::path& folder, const RunIdentity& identity,
               const ordered_json& sessions, const std::vector<CellResult>& results) {
  const auto failed = std::ranges::count_if(
      results, [](const CellResult& result) { return !is_ok(result.record); });
  const ordered_json all = {{"code", code_json()},
                            {"grid_hash", fmt::format("{:016x}", key_of(identity.grid))},
                            {"data_hash", identity.data},
                            {"files", files_json(identity)},
                            {"programs", identity.programs},
                            {"cells", results.size()},
                            {"failed", failed},
                            {"fingerprint", fingerprint(results)},
                            {"sessions", sessions}};
  write_file(folder / "provenance.json", write_json(all, 2) + "\n");
}

std::string hash_of_file(const std::filesystem::path& file) {
  return fmt::format("{:016x}", key_of(read_file_if_there(file).value_or("")));
}

}  // namespace

std::string version_with_commit() {
  const BuildInfo build = build_info();
  return fmt::format("{} ({}{})", build.version, build.commit, build.is_dirty ? ", dirty" : "");
}

std::string code_identity() {
  const BuildInfo build = build_info();
  if (build.commit != "unknown" && !build.is_dirty) return version_with_commit();
  return fmt::format("{} program {}", version_with_commit(), hash_of_file("/proc/self/exe"));
}

std::string fingerprint(const CellResult& result) {
  CellResult timeless = result;
  forget_costs(timeless.record);
  for (TraceRecord& point : timeless.trace) point.cpu_s = 0;
  return fmt::format("{:016x}", key_of(print_result(timeless)));
}

std::string fingerprint(const std::vector<CellResult>& results) {
  std::vector<std::string> parts;
  for (const CellResult& result : results) parts.push_back(fingerprint(result));
  std::ranges::sort(parts);
  return fmt::format("{:016x}", key_of(fmt::format("{}", fmt::join(parts, ""))));
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

void write_provenance(const std::filesystem::path& folder, const RunIdentity& identity,
                      const RunSession& session, const std::vector<CellResult>& results) {
  ordered_json sessions = earlier_sessions(folder / "provenance.json");
  sessions.push_back(session_json(session));
  write_all(folder, identity, sessions, results);
}

void write_merged_provenance(const std::filesystem::path& folder,
                             const std::vector<std::filesystem::path>& parts,
                             const JournalContents& merged) {
  ordered_json sessions = ordered_json::array();
  for (const std::filesystem::path& part : parts) {
    for (const ordered_json& session : earlier_sessions(part / "provenance.json")) {
      sessions.push_back(session);
    }
  }
  write_all(folder, merged.identity, sessions, merged.results);
}

}  // namespace tribench
