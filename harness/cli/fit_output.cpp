// SPDX-License-Identifier: MIT
#include "harness/cli/fit_output.hpp"

#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "algorithms/expression/operator_set.hpp"
#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "foundation/toml_table.hpp"
#include "problems/preparation/data_options_toml.hpp"

namespace tribench {
namespace {

constexpr const char* kWidestSet = "full";

using Json = nlohmann::ordered_json;

std::string figure(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : std::string("-");
}

Json intervals_json(const FitIntervals& intervals) {
  Json constants = Json::array();
  for (std::size_t k = 0; k < intervals.constants.size(); ++k) {
    const ConstantInterval& one = intervals.constants[k];
    constants.push_back({{"value", json_number(one.value)},
                         {"low", json_number(one.low)},
                         {"high", json_number(one.high)},
                         {"place", intervals.places[k]}});
  }
  Json all = {{"level", 0.95},
              {"given", "the form of the formula"},
              {"unit", intervals.unit},
              {"units", intervals.units},
              {"constants", constants},
              {"quantile", intervals.quantile},
              {"covariance", intervals.covariance}};
  if (!intervals.warning.empty()) all["warning"] = intervals.warning;
  return all;
}

// The keys of a grid's problem (data_options_toml.hpp).
Json reading_json(const DataOptions& reading) {
  toml::table table;
  insert_data_options(table, reading);
  std::ostringstream text;
  text << toml::json_formatter(table);
  return Json::parse(text.str());
}

// Who leaves the set at its default hardly knows what it does without.
void print_operators(const std::string& name) {
  if (name.empty()) return;
  const OperatorSet& set = find_operator_set(name);
  const OperatorSet& widest = find_operator_set(kWidestSet);
  fmt::print("operators {}: {}{}\n", name, set.summary(),
             name == kWidestSet
                 ? ""
                 : fmt::format("; --operators {} has {}", kWidestSet, widest.summary()));
}

}  // namespace

Json fit_json(const FitAnswer& answer) {
  const Record& record = answer.result.record;
  Json front = Json::array();
  for (const FrontRecord& entry : answer.result.front) {
    Json one = {{"formula", entry.formula},
                {"complexity", entry.complexity},
                {"mae_train", json_number(entry.mae_train)},
                {"mae_test", json_number(entry.mae_test)},
                {"singularity", record_word(entry.singularity)}};
    if (!std::isnan(entry.weighted_rms)) one["weighted_rms"] = entry.weighted_rms;
    front.push_back(std::move(one));
  }
  Json all = {{"formula", record.formula},
              {"complexity", record.complexity},
              {"nodes", record.nodes},
              {"mae_train", json_number(record.mae_train)},
              {"mae_test", json_number(record.mae_test)},
              {"evaluations", record.evaluations},
              {"fit_cpu_s", json_number(record.fit_cpu_s)},
              {"singularity", record_word(record.singularity)}};
  if (!record.witness.empty()) all["witness"] = nlohmann::json::parse(record.witness);
  if (!record.note.empty()) all["note"] = record.note;
  all["target"] = answer.target;
  all["inputs"] = answer.inputs;
  if (Json reading = reading_json(answer.reading); !reading.empty()) all["reading"] = reading;
  if (!answer.operators.empty()) all["operators"] = answer.operators;
  all["ended"] = answer.ended;
  all["reproduce"] = answer.reproduce;
  all["reproduces_exactly"] = answer.reproduces_exactly;
  if (answer.intervals) all["intervals"] = intervals_json(*answer.intervals);
  all["front"] = front;
  return all;
}

void print_fit(const FitAnswer& answer) {
  // The error that the choice was made by comes first.
  const bool is_weighted = std::ranges::any_of(answer.result.front, [](const FrontRecord& entry) {
    return !std::isnan(entry.weighted_rms);
  });
  fmt::print("  complexity{}     MAE train      MAE test  singularity  formula\n",
             is_weighted ? "  weighted RMS" : "");
  for (const FrontRecord& entry : answer.result.front) {
    const std::string weighted =
        is_weighted ? fmt::format("  {:>12}", figure(entry.weighted_rms)) : "";
    fmt::print("{} {:10}{}  {:>12}  {:>12}  {:11}  {}\n", entry.chosen ? '*' : ' ',
               entry.complexity, weighted, figure(entry.mae_train), figure(entry.mae_test),
               record_word(entry.singularity), entry.formula);
  }
  const Record& record = answer.result.record;
  fmt::print("\nchosen: {}\n", record.formula);
  if (!record.witness.empty()) fmt::print("singular at {}\n", record.witness);
  if (!record.note.empty()) fmt::print("note: {}\n", record.note);
  if (answer.intervals) {
    fmt::print("constants, 95 %, given the form ({} {}s as units):\n", answer.intervals->units,
               answer.intervals->unit);
    if (!answer.intervals->warning.empty()) fmt::print("  ({})\n", answer.intervals->warning);
    for (const ConstantInterval& one : answer.intervals->constants) {
      fmt::print("  {:<14} {}\n", figure(one.value),
                 std::isfinite(one.low) ? fmt::format("{} .. {}", figure(one.low), figure(one.high))
                                        : std::string("not determined by the rows"));
    }
  } else {
    fmt::print("no intervals: {}\n", answer.no_intervals);
  }
  print_operators(answer.operators);
  fmt::print("{} node-rows, {:.3g} CPU seconds; ended by: {}\nagain{}: {}\n", record.evaluations,
             record.fit_cpu_s, answer.ended,
             answer.reproduces_exactly ? "" : " (the clock had a say: perhaps another formula)",
             answer.reproduce);
}

Json category_json(const CategoryFit& fit) {
  Json categories = Json::array();
  const auto record_json = [](const Record& record) {
    return Json{{"formula", record.formula},
                {"complexity", record.complexity},
                {"mae_train", json_number(record.mae_train)},
                {"mae_test", json_number(record.mae_test)},
                {"rmse_test", json_number(record.rmse_test)},
                {"singularity", record_word(record.singularity)}};
  };
  for (const CategoryResult& each : fit.categories) {
    Json one = {{"category", each.category}, {"constants", each.constants}};
    one.update(record_json(each.record));
    one["own"] = record_json(each.own);
    categories.push_back(std::move(one));
  }
  return {{"shape", fit.shape},
          {"complexity", fit.complexity},
          {"evaluations", fit.evaluations},
          {"fit_cpu_s", json_number(fit.fit_cpu_s)},
          {"ended", fit.was_ended_by_clock ? "seconds" : "finished"},
          {"categories", categories}};
}

void print_category_fit(const CategoryFit& fit) {
  fmt::print("shape, p1() and so on constants of each category's own (complexity {}):\n  {}\n\n",
             fit.complexity, fit.shape);
  fmt::print("{:>10}  {:>12}  {:>12}  {:>12}  {:>12}  constants\n", "category", "MAE train",
             "MAE test", "own, train", "own, test");
  for (const CategoryResult& each : fit.categories) {
    std::string constants;
    for (const double value : each.constants) constants += " " + figure(value);
    fmt::print("{:>10}  {:>12}  {:>12}  {:>12}  {:>12} {}\n", figure(each.category),
               figure(each.record.mae_train), figure(each.record.mae_test),
               figure(each.own.mae_train), figure(each.own.mae_test), constants);
  }
  fmt::print("\neach one's own formula:\n");
  for (const CategoryResult& each : fit.categories) {
    fmt::print("{:>10}  {}\n", figure(each.category),
               is_ok(each.own) ? each.own.formula : "- " + reason_text(each.own.reason));
  }
  fmt::print("{} node-rows, {:.3g} CPU seconds; ended by: {}\n", fit.evaluations, fit.fit_cpu_s,
             fit.was_ended_by_clock ? "seconds" : "finished");
}

DataOptions read_fit_reading(const nlohmann::json& model, const std::string& file) {
  if (!model.contains("reading")) return {};
  std::string text;
  for (const auto& [key, value] : model["reading"].items()) {
    if (value.is_primitive() && !value.is_null()) text += key + " = " + write_json(value) + "\n";
  }
  const toml::table table = parse_toml(text, file);
  return read_data_options(TomlTable(table, file, "reading", data_option_keys()));
}

FitIntervals read_fit_intervals(const nlohmann::json& model, const Expression& formula,
                                const std::string& file) {
  FitIntervals intervals;
  try {
    const nlohmann::json& kept = model.at("intervals");
    intervals.quantile = kept.at("quantile");
    intervals.covariance = kept.at("covariance").get<std::vector<double>>();
    for (const nlohmann::json& one : kept.at("constants")) {
      const auto place = json_whole_number<std::size_t>(one.at("place"));
      intervals.places.push_back(place.value_or(formula.size()));  // no constant's: refused below
    }
  } catch (const nlohmann::json::exception&) {
    throw_bad_input("this model has no intervals", file, "save one by: tribench fit --save FILE");
  }
  const std::size_t p = intervals.places.size();
  if (intervals.covariance.size() != p * p) {
    throw_bad_input("the covariance does not fit the constants", file,
                    "save the model again by: tribench fit --save FILE");
  }
  for (const std::size_t place : intervals.places) {
    if (place < formula.size() && formula.node(place).is_constant()) continue;
    throw_bad_input("the intervals are of another formula", file,
                    "save the model again by: tribench fit --save FILE");
  }
  return intervals;
}

}  // namespace tribench
