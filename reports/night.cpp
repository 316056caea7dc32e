// SPDX-License-Identifier: MIT
#include "reports/night.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "foundation/elementary.hpp"
#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "foundation/order_statistics.hpp"
#include "foundation/random.hpp"

namespace tribench {
namespace {

using nlohmann::ordered_json;

constexpr std::string_view kMagic = "tribench-night 1 ";
constexpr std::size_t kCheckDigits = 16;

double spread_of(const NightSeries& series) {
  std::vector<double> errors;
  for (const auto& [seed, value] : series.log_errors) errors.push_back(value);
  if (errors.size() < 3) return kMissing;
  const double middle = median(errors);
  for (double& error : errors) error -= middle;
  return kMadToSd * upper_median_magnitude(errors);
}

NightSeries series_of(const std::vector<const Record*>& records) {
  NightSeries series;
  series.problem = records.front()->problem;
  series.method = records.front()->method;
  series.operators = records.front()->operators;
  std::vector<double> errors;
  std::vector<double> cpu;
  std::vector<double> evaluations;
  for (const Record* record : records) {
    ++series.cells;
    if (!is_ok(*record)) {
      ++series.failed;
      continue;
    }
    if (record->singularity == Singularity::refuted) ++series.singular;
    errors.push_back(record->mae_test);
    cpu.push_back(record->fit_cpu_s);
    evaluations.push_back(static_cast<double>(record->evaluations));
    if (record->mae_test > 0 && std::isfinite(record->mae_test)) {
      series.log_errors.emplace_back(record->seed,
                                     static_cast<float>(elementary::log(record->mae_test)));
    }
  }
  series.median_error = median(errors);
  series.cpu_s = median(cpu);
  series.evaluations = median(evaluations);
  series.spread = spread_of(series);
  return series;
}

std::string printed(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : std::string("-");
}

[[noreturn]] void throw_damaged(const std::string& place) {
  throw_bad_input("this is no night's record, or it is damaged", place,
                  "bring it back from a copy of the store");
}

// The next field of a line, cut off from its front.
std::string_view next_field(std::string_view& line, char separator) {
  const std::size_t end = std::min(line.find(separator), line.size());
  const std::string_view field = line.substr(0, end);
  line.remove_prefix(std::min(end + 1, line.size()));
  return field;
}

template <typename Number>
Number number_in(std::string_view field, const std::string& place) {
  if constexpr (std::floating_point<Number>) {
    if (field == "-") return std::numeric_limits<Number>::quiet_NaN();
  }
  Number value{};
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || end != field.data() + field.size()) throw_damaged(place);
  return value;
}

NightSeries read_series(std::string_view line, const std::string& place, bool with_seeds) {
  NightSeries series;
  series.problem = next_field(line, ',');
  series.method = next_field(line, ',');
  series.operators = next_field(line, ',');
  series.cells = number_in<std::size_t>(next_field(line, ','), place);
  series.failed = number_in<std::size_t>(next_field(line, ','), place);
  series.singular = number_in<std::size_t>(next_field(line, ','), place);
  series.median_error = number_in<double>(next_field(line, ','), place);
  series.cpu_s = number_in<double>(next_field(line, ','), place);
  series.evaluations = number_in<double>(next_field(line, ','), place);
  std::string_view seeds = next_field(line, ',');
  if (!line.empty()) series.spread = number_in<double>(line, place);  // older nights have none
  while (with_seeds && !seeds.empty()) {
    std::string_view pair = next_field(seeds, ' ');
    const auto seed = number_in<std::uint64_t>(next_field(pair, ':'), place);
    series.log_errors.emplace_back(seed, number_in<float>(pair, place));
  }
  return series;
}

// A case's name may hold anything but the end of a line; it stands last.
std::string print_bench(const NightBench& bench) {
  return fmt::format("{},{},{},{},{},{}\n", printed(bench.instructions),
                     printed(bench.first_level_misses), printed(bench.last_level_misses),
                     printed(bench.time), printed(bench.time_spread), bench.name);
}

NightBench read_bench(std::string_view line, const std::string& place) {
  NightBench bench;
  for (double* figure : {&bench.instructions, &bench.first_level_misses, &bench.last_level_misses,
                         &bench.time, &bench.time_spread}) {
    *figure = number_in<double>(next_field(line, ','), place);
  }
  bench.name = line;
  return bench;
}

// The night's words; returns the number of its benches.
std::size_t read_header(std::string_view line, Night& night, const std::string& place) {
  const ordered_json header = read_json<ordered_json>(line);
  if (!header.is_object()) throw_damaged(place);
  try {
    night.name = header.value("name", "");
    night.started = header.value("started", "");
    night.code = header.value("code", "");
    night.commit = header.value("commit", "");
    night.machine = header.value("machine", "");
    night.grid = header.value("grid", "");
    night.data = header.value("data", "");
    night.outcome = header.value("outcome", "");
    night.bench_conditions = header.value("bench_conditions", "");
    const auto benches = header.find("benches");
    if (benches == header.end()) return 0;
    const auto count = json_whole_number<std::size_t>(*benches);
    if (!count) throw_damaged(place);
    return *count;
  } catch (const ordered_json::exception&) {  // another type
    throw_damaged(place);
  }
}

}  // namespace

Night night_of_run(const RunFolder& run, std::string name) {
  if (run.records.empty()) throw_bad_input("the run has no results", run.path.string());
  Night night;
  night.name = std::move(name);
  night.started = run.provenance_of("sessions.0.started");
  night.commit = run.provenance_of("code.commit");
  night.code = run.provenance_of("code.version");
  night.machine = run.provenance_of("sessions.0.machine.cpu");
  night.grid = run.provenance_of("grid_hash");
  night.data = run.provenance_of("data_hash");
  std::map<std::string, std::vector<const Record*>> groups;
  for (const Record& record : run.records) {
    groups[record.problem + "|" + record.method + "|" + record.operators].push_back(&record);
  }
  for (const auto& [key, records] : groups) night.series.push_back(series_of(records));
  return night;
}

std::string print_night(const Night& night) {
  std::string body = write_json(ordered_json{{"name", night.name},
                                             {"started", night.started},
                                             {"code", night.code},
                                             {"commit", night.commit},
                                             {"machine", night.machine},
                                             {"grid", night.grid},
                                             {"data", night.data},
                                             {"outcome", night.outcome},
                                             {"benches", night.benches.size()},
                                             {"bench_conditions", night.bench_conditions}}) +
                     "\n";
  for (const NightSeries& series : night.series) {
    body +=
        fmt::format("{},{},{},{},{},{},{},{},{},", series.problem, series.method, series.operators,
                    series.cells, series.failed, series.singular, printed(series.median_error),
                    printed(series.cpu_s), printed(series.evaluations));
    for (std::size_t i = 0; i < series.log_errors.size(); ++i) {
      const auto& [seed, value] = series.log_errors[i];
      body += fmt::format("{}{}:{:.6g}", i == 0 ? "" : " ", seed, value);
    }
    if (std::isfinite(series.spread)) body += "," + printed(series.spread);
    body += "\n";
  }
  for (const NightBench& bench : night.benches) body += print_bench(bench);
  return night_text(body);
}

std::string night_text(std::string_view body) {
  return fmt::format("{}{:016x}\n{}", kMagic, key_of(body), body);
}

Night read_night(std::string_view text, const std::string& place, bool with_seeds) {
  const std::size_t head = kMagic.size() + kCheckDigits;
  if (text.size() < head + 1 || !text.starts_with(kMagic) || text[head] != '\n') {
    throw_damaged(place);
  }
  const std::string_view check = text.substr(kMagic.size(), kCheckDigits);
  text.remove_prefix(head + 1);
  if (fmt::format("{:016x}", key_of(text)) != check) throw_damaged(place);
  Night night;
  const std::size_t benches = read_header(next_field(text, '\n'), night, place);
  const auto lines = static_cast<std::size_t>(std::ranges::count(text, '\n'));
  if (benches > lines) throw_damaged(place);
  while (night.series.size() + benches < lines) {
    night.series.push_back(read_series(next_field(text, '\n'), place, with_seeds));
  }
  while (!text.empty()) night.benches.push_back(read_bench(next_field(text, '\n'), place));
  return night;
}

}  // namespace tribench
