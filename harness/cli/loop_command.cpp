// SPDX-License-Identifier: MIT
//
// tribench loop: measured data and a base model in, the missing effects and the refitted model out.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "algorithms/budget.hpp"
#include "algorithms/closed_loop/closed_loop.hpp"
#include "algorithms/diagnosis/diagnosis.hpp"
#include "foundation/error.hpp"
#include "foundation/number_text.hpp"
#include "foundation/output_file.hpp"
#include "foundation/output_folder.hpp"
#include "harness/cli/choice_option.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/data_options.hpp"
#include "harness/cli/number_options.hpp"
#include "harness/loop/loop_motion.hpp"
#include "harness/loop/loop_record_of.hpp"
#include "harness/machine.hpp"
#include "harness/progress_line.hpp"
#include "problems/preparation/recording.hpp"
#include "problems/reading/explanation.hpp"
#include "reports/loop_report.hpp"
#include "reports/loop_words.hpp"
#include "reports/picture_files.hpp"
#include "reports/record/loop_json.hpp"

namespace tribench {
namespace {

// Fewer of a movement hardly tell its noise from what makes it another one.
constexpr std::size_t kUsualRows = 6000;
constexpr std::size_t kRowsOfMovement = 10;

struct LoopArguments {
  std::vector<std::string> files;
  std::string model = "coulomb_viscous";
  std::vector<std::string> rigid;
  std::vector<std::string> effects;
  double screw_lead = 0;
  double alpha_library = 0.003;
  double alpha_leftover = 0.002;
  int flips = 1999;
  std::optional<int> rows;
  std::uint64_t seed = 1;
  std::uint64_t evaluations = 200'000'000;
  std::shared_ptr<DataOptions> reading = std::make_shared<DataOptions>();
  Gravity gravity = Gravity::automatic;
  bool explain = false;
  bool any_sign = false;
  std::optional<double> min_speed;
  bool unordered = false;
  bool steady = false;
  std::string leave_out;
  bool json = false;
  int suggest = 0;
  int jobs = 0;
  std::string learn = "none";
  std::uint64_t learn_evaluations = 50'000'000;
  std::string learned;
  std::string save_effect;
  std::string out;
  std::string pictures;
};

bool is_word(const std::string& text) {
  return std::ranges::all_of(text,
                             [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
}

// The base that --model names: a method of the registry, which has the budget for every search
// anew so that none waits for another, or a formula over the columns.
loop::BaseMaker base_of(const LoopArguments& arguments, const Registry& registry,
                        std::unique_ptr<Regressor>& method) {
  if (arguments.model == "coulomb_viscous") return loop::coulomb_viscous_base;
  const bool known =
      std::ranges::count(registry.entries(), arguments.model, &AlgorithmEntry::name) > 0;
  if (!known && !is_word(arguments.model)) {
    const std::string text = arguments.model;
    return [text](const loop::Observations& data) { return loop::formula_base(data, text); };
  }
  method = registry.make(arguments.model);  // an unknown name is answered with the nearest
  return [&method, name = arguments.model, random = RandomStream(arguments.seed).split("base"),
          limits =
              BudgetLimits{.evaluations = arguments.evaluations}](const loop::Observations& data) {
    Budget budget(limits);
    return loop::method_base(*method, name, random, budget)(data);
  };
}

// A column of numbers or text as a channel of numbers, one a value: rows may then be left out and
// movements cut without losing it.
void code_column(DataFile& file, const std::string& column) {
  const auto text = std::ranges::find(file.texts, column, &TextColumn::name);
  if (text == file.texts.end()) {
    file.data.at(column);  // an unknown one is answered with the nearest
    return;
  }
  std::vector<std::string> names;
  Channel codes{column, "-", Role::none, {}};
  for (const std::string& value : text->values) {
    const auto known = std::ranges::find(names, value);
    codes.values.push_back(static_cast<double>(known - names.begin()));
    if (known == names.end()) names.push_back(value);
  }
  file.data.channels.push_back(std::move(codes));
}

// Which movements have the same value in a column.
std::vector<int> groups_by(const Dataset& data, const std::string& column) {
  std::vector<double> values;
  std::vector<int> groups(data.movement_names.size(), -1);
  const std::vector<double>& rows = data.at(column).values;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto known = std::ranges::find(values, rows[i]);
    const int number = static_cast<int>(known - values.begin());
    if (known == values.end()) values.push_back(rows[i]);
    int& group = groups[static_cast<std::size_t>(data.movement[i])];
    if (group != -1 && group != number) {
      throw_bad_input(fmt::format("'{}' changes within a movement (row {})", column, i + 1),
                      "--leave-out", "name a column that is the same all through a movement");
    }
    group = number;
  }
  if (values.size() < 2) {
    throw_bad_input(fmt::format("'{}' is the same in every movement", column), "--leave-out",
                    "name a column that tells movements apart");
  }
  return groups;
}

DataFile read_files(const LoopArguments& arguments) {
  const std::vector<std::filesystem::path> files(arguments.files.begin(), arguments.files.end());
  std::vector<std::string> used = arguments.rigid;
  if (!arguments.leave_out.empty()) used.push_back(arguments.leave_out);
  constexpr bool kSpareColumnsToo = true;
  DataFile file = read_data(files, *arguments.reading, used, kSpareColumnsToo);
  if (!arguments.leave_out.empty()) code_column(file, arguments.leave_out);
  return file;
}

loop::DiagnosisOptions diagnosis_options(const LoopArguments& arguments) {
  loop::DiagnosisOptions options;
  options.alpha_library = arguments.alpha_library;
  options.alpha_leftover = arguments.alpha_leftover;
  options.flips = static_cast<std::size_t>(arguments.flips);
  loop::require_enough_flips(options);
  options.families = arguments.effects;
  options.physical_vetoes = !arguments.any_sign;
  if (!arguments.learned.empty()) options.learned = loop::read_effects(arguments.learned);
  if (arguments.reading->drive.gear_ratio) {
    options.gear_ratios = {*arguments.reading->drive.gear_ratio};
  }
  if (arguments.screw_lead > 0) options.gear_ratios = {2 * std::numbers::pi / arguments.screw_lead};
  return options;
}

loop::JudgingOptions judging_options() {
  loop::JudgingOptions judging;
  judging.bounds = true;
  judging.resample = true;
  return judging;
}

std::string title_of(const LoopArguments& arguments) {
  std::string title;
  for (const std::string& file : arguments.files) {
    title += (title.empty() ? "" : ", ") + std::filesystem::path(file).filename().string();
  }
  return title;
}

void print_extras(const LoopArguments& arguments, const loop::LoopExtras& extras,
                  const loop::Observations& data) {
  for (const loop::LearnedEffect& one : extras.learned) {
    fmt::print("  learned ({}; p = {:.2g} on {} movements it was not found on): {}\n",
               one.accepted ? "accepted" : "not confirmed", one.p, one.tested_on, one.formula);
  }
  const bool saved = std::ranges::any_of(extras.learned, &loop::LearnedEffect::accepted);
  if (!arguments.save_effect.empty() && !saved) {
    fmt::print("  no effect was learned: {} is not written\n", arguments.save_effect);
  }
  if (!extras.suggestions.empty()) {
    fmt::print("  next movements:\n{}", loop::movements_csv(extras.suggestions, data));
  } else if (arguments.suggest > 0) {
    fmt::print(
        "  no next movement: no explanations are left that a movement of this axis tells apart\n");
  }
}

loop::JudgedDiagnosis diagnosed(const LoopArguments& arguments, const loop::Observations& data,
                                const loop::BaseMaker& base,
                                const loop::DiagnosisOptions& options) {
  constexpr double kShownFrom_s = 2;
  loop::JudgingOptions judging = judging_options();
  judging.threads = arguments.jobs > 0 ? arguments.jobs : usable_processors();
  std::size_t expected = 0;
  ProgressLine line(0, 0, false, ProgressUnit{"searches", false, kShownFrom_s});
  judging.progress = [&](std::size_t, std::size_t searches) {
    line.expect_more(searches - expected, static_cast<double>(searches - expected));
    expected = searches;
    line.cell_ended(1, false);
  };
  return loop::diagnose_and_judge(data, base, options, judging);
}

// Something is left over: lets a method grow the library, and where its formula holds on movements
// it was not found on, runs the loop again with it.
void grow_library(const LoopArguments& arguments, const Registry& registry,
                  const loop::Observations& data, const loop::BaseMaker& base,
                  loop::JudgedDiagnosis& diagnosis, loop::LoopExtras& extras) {
  const std::unique_ptr<Regressor> method = registry.make(arguments.learn);
  Budget budget(BudgetLimits{.evaluations = arguments.learn_evaluations});
  const std::optional<loop::LearnedEffect> learned =
      loop::learn_effect(diagnosis, data, *method, arguments.learn, budget, arguments.seed);
  if (!learned) return;
  extras.learned.push_back(*learned);
  if (!learned->accepted) return;
  loop::DiagnosisOptions options = diagnosis_options(arguments);
  options.learned.push_back(learned->family);
  diagnosis = diagnosed(arguments, data, base, options);
  for (loop::EffectFinding& effect : diagnosis.effects) {
    if (effect.family != learned->family.name) continue;
    // Its p on movements it was not found on; the search's own would flatter it.
    effect.adjusted_p = learned->p;
    effect.notes.push_back(fmt::format("found by {} on {} movements, tested on {} others",
                                       arguments.learn, learned->found_on, learned->tested_on));
  }
  if (arguments.save_effect.empty()) return;
  write_file(arguments.save_effect, loop::write_effects(std::vector{learned->family}));
}

// What was read, before neighbouring rows are averaged: the motion is simulated along it.
struct LoopRecording {
  Dataset data;
  loop::PositionUnit unit;
};

loop::Observations read_observations(const LoopArguments& arguments,
                                     std::vector<LoopDataStep>& steps, LoopRecording& whole) {
  DataFile file = read_files(arguments);
  steps.push_back({"read from the file", file.data.rows(), {}});
  whole.unit = loop::position_unit(file);
  // Who says which rows are slow means those and no others.
  PreparedRecording recording = prepare(std::move(file), *arguments.reading, arguments.gravity,
                                        arguments.min_speed ? SlowRows::kept : SlowRows::left_out);
  const std::size_t moving = recording.data.rows() + recording.unresolved;
  steps.push_back({"cut into movements, derived channels added", moving, {}});
  if (recording.unresolved > 0) {
    const char* part =
        recording.data.find(Role::friction_torque) != nullptr ? "velocity" : "acceleration";
    steps.push_back({fmt::format("{} resolved", part), recording.data.rows(),
                     fmt::format("in {} of {} rows the {} changes faster than the position shows, "
                                 "where late friction shows most; gentler starts, a finer "
                                 "encoder or a column of the {} would open "
                                 "them",
                                 recording.unresolved, moving, part, part)});
  }
  std::vector<std::string> rigid = arguments.rigid;
  rigid.insert(rigid.end(), recording.rigid.begin(), recording.rigid.end());
  loop::Observations data = loop::observe(
      recording.data, {rigid, arguments.min_speed, arguments.unordered, arguments.steady});
  data.turns_left_out = recording.unresolved > 0;
  if (!arguments.leave_out.empty()) {
    data.group = groups_by(recording.data, arguments.leave_out);
    data.group_name = arguments.leave_out;
  }
  std::vector<std::string>& notes = recording.notes;
  whole.data = std::move(recording.data);
  const std::size_t all_rows = data.rows();
  steps.push_back({"rows that count for friction", all_rows, {}});
  const std::size_t usual = std::max(kUsualRows, kRowsOfMovement * data.movements().size());
  const loop::Shortened shortened =
      data.averaged(arguments.rows ? static_cast<std::size_t>(*arguments.rows) : usual);
  data = shortened.data;
  if (data.rows() < all_rows)
    steps.push_back({"neighbouring rows averaged or thinned", data.rows(), {}});
  if (data.rows() < all_rows) {
    notes.push_back(shortened.rows_each > 1
                        ? fmt::format("{} rows are averaged over {:.3g} neighbours each{} (--rows)",
                                      data.rows(), shortened.rows_each, shortened.left_between)
                        : fmt::format("{} of {} rows are used{} (--rows)", data.rows(), all_rows,
                                      shortened.left_between));
  }
  data.warnings.insert(data.warnings.begin(), notes.begin(), notes.end());
  return data;
}

// What was understood, and what would be done; nothing is diagnosed.
void explain(const LoopArguments& arguments) {
  DataFile file = read_files(arguments);
  fmt::print("{}", explanation(file));
  if (!what_is_missing(file).empty()) return;
  const PreparedRecording recording =
      prepare(std::move(file), *arguments.reading, arguments.gravity);
  for (const std::string& note : recording.notes) fmt::print("{}\n", note);
  fmt::print("{} rows in {} movements\n", recording.data.rows(),
             recording.data.movement_names.size());
}

ExitStatus close_loop(const LoopArguments& arguments, const Registry& registry) {
  // Before any work, and before it is said what would be done: a level that cannot be reached, and
  // a file of effects that has none.
  const loop::DiagnosisOptions options = diagnosis_options(arguments);
  if (arguments.explain) {
    explain(arguments);
    return ExitStatus::done;
  }
  // A folder that cannot be written to, an unknown name, a file that nothing would be written to.
  if (!arguments.out.empty()) make_output_folder(arguments.out);
  if (!arguments.pictures.empty()) make_picture_folder(arguments.pictures);
  if (!arguments.save_effect.empty()) try_output_file(arguments.save_effect);
  if (arguments.learn != "none") {
    registry.make(arguments.learn);
  } else if (!arguments.save_effect.empty()) {
    throw_bad_input("there is no effect to save without --learn", "--save-effect",
                    "name a method: --learn pysr");
  }
  loop::LoopExtras extras;
  extras.title = title_of(arguments);
  extras.seed = arguments.seed;
  LoopRecording whole;
  const loop::Observations data = read_observations(arguments, extras.steps, whole);
  std::unique_ptr<Regressor> method;
  const loop::BaseMaker base = base_of(arguments, registry, method);
  loop::JudgedDiagnosis diagnosis = diagnosed(arguments, data, base, options);
  if (arguments.learn != "none" && !diagnosis.leftover.signals.empty()) {
    grow_library(arguments, registry, data, base, diagnosis, extras);
  }
  if (arguments.suggest > 0) {
    extras.suggestions =
        loop::propose_movements(diagnosis, data, static_cast<std::size_t>(arguments.suggest));
  }
  extras.motion = loop::loop_motion(diagnosis, data, std::move(whole.data), whole.unit);
  const LoopRecord record = loop::loop_record_of(diagnosis, data, extras);
  if (!arguments.out.empty()) {
    const std::filesystem::path folder = arguments.out;
    write_loop_report(record, folder);
    if (extras.suggestions.empty()) {
      std::filesystem::remove(folder / "next_movements.csv");  // an earlier run's
    } else {
      write_file(folder / "next_movements.csv", loop::movements_csv(extras.suggestions, data));
    }
  }
  if (!arguments.pictures.empty()) write_loop_pictures(record, arguments.pictures);
  if (arguments.json) {
    fmt::print("{}", write_loop_json(record));
  } else {
    fmt::print("{}", loop_terminal(record, isatty(STDOUT_FILENO) != 0));
    print_extras(arguments, extras, data);
  }
  return diagnosis.verdict == loop::Verdict::cannot_tell ? ExitStatus::undecided : ExitStatus::done;
}

// What the joint is and what is known of it.
void add_base_options(CLI::App& command, LoopArguments& arguments) {
  command
      .add_option("--model", arguments.model,
                  "the base: coulomb_viscous, symmetric, asymmetric, any method, a 'FORMULA'")
      ->capture_default_str();
  command
      .add_option("--rigid", arguments.rigid,
                  "columns of the rigid body, fitted with the base and no effects")
      ->delimiter(',');
  command.add_option("--effects", arguments.effects, "test these families only")->delimiter(',');
  CLI::Option* gear_ratio = add_data_options(command, arguments.reading);
  gear_ratio->description(
      "motor turns per turn of the joint; without it the usual ones are scanned for ripples, and "
      "what repeats with another period is found from loop.json's shortest_wave on");
  take_one_of<Gravity>(
      command.add_option("--gravity", arguments.gravity,
                         "gravity that no column declares: fit sin and cos of the position with "
                         "the base, none, or auto: where that explains much"),
      {{"auto", Gravity::automatic}, {"fit", Gravity::fit}, {"none", Gravity::none}});
  command
      .add_option("--urdf", arguments.reading->urdf,
                  "URDF of the arm, beside --joint and positions of all joints: gravity from it")
      ->check(CLI::ExistingFile);
  command.add_flag("--explain", arguments.explain,
                   "say what each column was taken for and what would be done, and stop");
  command
      .add_option(
          "--screw-lead", arguments.screw_lead,
          "of a linear axis, m per turn of the screw; without it the usual ones are scanned")
      ->transform(real_number(0, 1e6, LowEnd::above))
      ->excludes(gear_ratio);
}

// How sure an effect has to be.
void add_test_options(CLI::App& command, LoopArguments& arguments) {
  command.add_option("--alpha", arguments.alpha_library, "false alarms of the library")
      ->transform(real_number(1e-5, 0.5))
      ->capture_default_str();
  command.add_option("--alpha-leftover", arguments.alpha_leftover, "false alarms of UNKNOWN")
      ->transform(real_number(1e-5, 0.5))
      ->capture_default_str();
  command.add_option("--flips", arguments.flips, "sign flips of the null distribution")
      ->transform(whole_number(99, 99999))
      ->capture_default_str();
}

// Which rows count, and how.
void add_row_options(CLI::App& command, LoopArguments& arguments) {
  command
      .add_option("--min-speed", arguments.min_speed,
                  "leave out slower rows: the direction of friction is not known there; without it "
                  "the speed is found from rows at rest")
      ->transform(real_number(0, 1e6));
  command.add_option("--leave-out", arguments.leave_out,
                     "COLUMN: judge by leaving out, in turn, all movements that share its value");
  command.add_flag("--unordered", arguments.unordered,
                   "the order of the movements says nothing: no drift");
  command.add_flag(
      "--steady", arguments.steady,
      "each movement holds one speed: average it, its velocity's noise is not friction");
  command
      .add_option("--rows", arguments.rows,
                  "average neighbours of a longer recording, to about so many; default: 6000, or "
                  "ten a movement where that is more")
      ->transform(whole_number(100, 10'000'000));
}

// What is searched for beyond the library, and what it may spend.
void add_search_options(CLI::App& command, LoopArguments& arguments) {
  command.add_option("--seed", arguments.seed, "same seed, same answer")
      ->transform(whole_number(0))
      ->capture_default_str();
  command.add_option("--jobs", arguments.jobs, "threads; the answer is the same for any")
      ->transform(whole_number(0, 1024));
  command
      .add_option("--evaluations", arguments.evaluations,
                  "what a searched base may spend in each search")
      ->transform(whole_number(0))
      ->capture_default_str();
  command.add_flag("--any-sign", arguments.any_sign,
                   "accept effects whose parameters are not physical");
  command
      .add_option("--suggest", arguments.suggest,
                  "propose so many next movements that tell the rivals left apart")
      ->transform(whole_number(0, 1000));
  command
      .add_option("--learn", arguments.learn,
                  "method that learns a new effect from what is left over, or none")
      ->capture_default_str();
  command.add_option("--learn-evaluations", arguments.learn_evaluations, "what it may spend")
      ->transform(whole_number(0))
      ->capture_default_str();
  command.add_option("--save-effect", arguments.save_effect, "write a learned effect to a file");
  command
      .add_option("--learned", arguments.learned,
                  "test the effects of such a file (or of one made by hand) too")
      ->check(CLI::ExistingFile);
}

// Where the answer goes.
void add_answer_options(CLI::App& command, LoopArguments& arguments) {
  command.add_flag("--json", arguments.json, "print loop.json");
  command.add_option("--out", arguments.out, "folder for loop.json, loop.md, loop.html");
  command.add_option("--pictures", arguments.pictures,
                     "folder for every picture of the page, as SVG and PNG");
}

}  // namespace

void add_loop_command(CLI::App& app, ExitStatus& status, const Registry& registry) {
  CLI::App* command = app.add_subcommand(
      "loop", "Find what a friction model lacks in measured data, add it and refit");
  command->footer(
      "Example: tribench loop joint2.csv --model symmetric --gear-ratio 160 --out joint2");
  auto arguments = std::make_shared<LoopArguments>();
  command->add_option("DATA", arguments->files, "CSV files: one campaign, in order")->required();
  add_base_options(*command, *arguments);
  add_test_options(*command, *arguments);
  add_row_options(*command, *arguments);
  add_search_options(*command, *arguments);
  add_answer_options(*command, *arguments);
  command->callback([arguments, &status, &registry] { status = close_loop(*arguments, registry); });
}

}  // namespace tribench
