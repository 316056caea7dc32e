// SPDX-License-Identifier: MIT
//
// tribench simulate: the motion that a friction formula predicts, against the recorded one.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "algorithms/expression/text.hpp"
#include "algorithms/states/state_text.hpp"
#include "foundation/error.hpp"
#include "foundation/number_text.hpp"
#include "foundation/output_file.hpp"
#include "foundation/output_folder.hpp"
#include "foundation/random.hpp"
#include "foundation/standard_streams.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/data_options.hpp"
#include "harness/cli/loop_formula.hpp"
#include "harness/cli/model_argument.hpp"
#include "harness/cli/number_options.hpp"
#include "harness/motion/motion_trial.hpp"
#include "problems/preparation/motion_check.hpp"
#include "problems/table.hpp"
#include "problems/user/user_problem.hpp"
#include "reports/motion_report.hpp"

namespace tribench {
namespace {

struct SimulateArguments {
  std::string model;
  std::vector<std::string> files;
  std::string test;
  std::shared_ptr<DataOptions> reading = std::make_shared<DataOptions>();
  MotionSetup setup;
  std::string inertia;
  std::string gravity;
  double motor_constant = 0;
  double resistance = 0;
  double most_current = 0;
  std::string reference;
  double kp = 0;
  double kd = 0;
  std::vector<std::string> refine;
  std::optional<user::HeldOut> held_out;
  std::uint64_t seed = 1;
  std::string unit;
  bool json = false;
  std::string out;
};

// The names in the texts that are columns of the file: what has to be read beside the roles.
std::vector<std::string> used_columns(const SimulateArguments& arguments, const MotionSetup& setup,
                                      const DataFile& file) {
  std::vector<std::string> names;
  parse_stateful_collecting(setup.formula, names);
  for (const std::string* text : {&setup.control, &setup.limit}) {
    if (!text->empty()) parse_collecting_names(*text, names);
  }
  std::set<std::string> wanted(names.begin(), names.end());
  for (const std::string& name : names) {  // NAME_2 of a controller, sgn_NAME of a formula
    wanted.insert(name.substr(0, name.rfind('_')));
    if (name.starts_with("sgn_")) wanted.insert(name.substr(4));
  }
  wanted.insert(setup.connected);
  if (arguments.held_out) wanted.insert(arguments.held_out->column);
  std::vector<std::string> used;
  for (const ColumnReading& column : file.readings) {
    if (wanted.contains(column.column)) used.push_back(column.column);
  }
  return used;
}

DataFile read_recording(const SimulateArguments& arguments, const MotionSetup& setup,
                        const std::vector<std::string>& names) {
  const std::vector<std::filesystem::path> files(names.begin(), names.end());
  const DataFile first = read_data(files, *arguments.reading, std::vector<std::string>{});
  DataFile file = read_data(files, *arguments.reading, used_columns(arguments, setup, first));
  if (const std::string made = make_torque(file.data, *arguments.reading); !made.empty()) {
    print_message(fmt::format("tribench: {}\n", made));
  }
  check_motion(file, arguments.reading->drive.gear_ratio);
  return file;
}

// A loop.json tells the gravity that it fitted, unless an option does.
void read_model(const SimulateArguments& arguments, MotionSetup& setup) {
  const nlohmann::json model = model_argument(arguments.model);
  setup.formula = model["formula"].get<std::string>();
  if (!model.contains("symbols")) return;
  if (arguments.gravity.empty()) setup.gravity = loop_formula_of(model, arguments.model).gravity;
}

// "4.9*sin(q)", "fit", "none", "1.2"
void read_body(const SimulateArguments& arguments, MotionSetup& setup) {
  if (arguments.inertia == "fit") {
    setup.fit_inertia = true;
  } else if (!arguments.inertia.empty()) {
    const std::optional<double> inertia = read_number<double>(arguments.inertia);
    if (!inertia || !(*inertia > 0)) {
      throw_bad_input(fmt::format("'{}' is no inertia", arguments.inertia), "--inertia",
                      "give kg m^2 (kg of a slide) above 0, or fit");
    }
    setup.inertia = *inertia;
  }
  if (arguments.gravity == "fit") {
    setup.fit_gravity = true;
  } else if (!arguments.gravity.empty() && arguments.gravity != "none") {
    setup.gravity = arguments.gravity;
  }
  if (setup.is_whole && (setup.inertia || setup.fit_inertia || setup.fit_gravity)) {
    throw_bad_input("nothing is added to a formula that is the whole torque", "--whole",
                    "leave out --inertia and --gravity fit, or --whole");
  }
  if ((arguments.motor_constant > 0) != (arguments.resistance > 0)) {
    throw_bad_input("a motor under voltage has a constant and a resistance",
                    arguments.resistance > 0 ? "--motor-constant" : "--resistance",
                    "give both, or neither where the drive is a torque");
  }
  if (arguments.resistance > 0) {
    setup.motor = forward::Motor{arguments.motor_constant, arguments.resistance};
    if (arguments.most_current > 0) setup.motor->most_current = arguments.most_current;
  } else if (arguments.most_current > 0) {
    throw_bad_input("a limit of the current belongs to a motor under voltage", "--current-limit",
                    "give --motor-constant and --resistance too");
  }
}

void read_control(const SimulateArguments& arguments, MotionSetup& setup) {
  if (arguments.reference.empty()) {
    if (arguments.kp != 0 || arguments.kd != 0) {
      throw_bad_input("gains without a reference", "--kp", "name its column: --reference COLUMN");
    }
    return;
  }
  setup.control = fmt::format("{}*({} - q) - {}*v", print_number(arguments.kp), arguments.reference,
                              print_number(arguments.kd));
}

// The position's name stands for the simulated one: a law that follows it does nothing.
void require_own_reference(const SimulateArguments& arguments, const Dataset& data) {
  const Channel* position = data.find(Role::position);
  const bool is_position =
      arguments.reference == "q" || (position != nullptr && position->name == arguments.reference);
  if (arguments.reference.empty() || !is_position) return;
  throw_bad_input(
      fmt::format("'{}' is the simulated position here, which the law would follow to itself",
                  arguments.reference),
      "--reference", "copy the recorded one to a column of another name, such as 'reference_rad'");
}

void read_refined(const SimulateArguments& arguments, MotionSetup& setup) {
  for (const std::string& what : arguments.refine) {
    const bool all = what == "all";
    setup.refine.inertia = setup.refine.inertia || all || what == "inertia";
    setup.refine.gravity = setup.refine.gravity || all || what == "gravity";
    setup.refine.motor = setup.refine.motor || all || what == "motor";
    setup.refine.friction = setup.refine.friction || all || what == "friction";
  }
}

void read_unit(const SimulateArguments& arguments, const Dataset& data, MotionSetup& setup) {
  const Channel* position = data.find(Role::position);
  if (position == nullptr) {
    throw_bad_input("there is no position to compare with", data.name,
                    "say which column it is: --roles COLUMN=position");
  }
  setup.unit = position->unit;
  if (arguments.unit.empty()) return;
  const Unit* unit = find_unit(arguments.unit);
  if (unit == nullptr || unit->si != position->unit || unit->counts) {
    throw_bad_input(
        fmt::format("'{}' is no unit of a position in {}", arguments.unit, position->unit),
        "--unit", position->unit == "m" ? "m, mm ..." : "rad, deg ...");
  }
  setup.unit = std::string(unit->symbol);
  setup.unit_size = unit->factor;
}

// Whether a row has one of the values in a column of numbers, of text, or that of the movements.
class RowsWith {
 public:
  RowsWith(const DataFile& file, const user::HeldOut& wanted) : file_(file), wanted_(wanted) {
    const auto text = std::ranges::find(file.texts, wanted.column, &TextColumn::name);
    const auto reading = std::ranges::find(file.readings, wanted.column, &ColumnReading::column);
    if (reading != file.readings.end() && reading->role == Role::movement) {
      return;
    }
    if (text != file.texts.end()) {
      text_ = &*text;
    } else {
      numbers_ = &file.data.at(wanted.column);
    }
  }
  bool has(std::size_t row) const {
    return std::ranges::any_of(wanted_.values, [&](const std::string& value) {
      if (numbers_ != nullptr) return read_number<double>(value) == numbers_->values[row];
      if (text_ != nullptr) return text_->values[row] == value;
      return file_.data.movement_names[static_cast<std::size_t>(file_.data.movement[row])] == value;
    });
  }

 private:
  const DataFile& file_;
  const user::HeldOut& wanted_;
  const TextColumn* text_ = nullptr;
  const Channel* numbers_ = nullptr;
};

// Movements that take no part in a fit.
std::vector<char> held_out_movements(const SimulateArguments& arguments, const DataFile& file) {
  const Dataset& data = file.data;
  std::vector<char> held_out(data.movement_names.size(), 0);
  if (!arguments.held_out) return held_out;
  const user::HeldOut& wanted = *arguments.held_out;
  if (wanted.kind != user::HeldOut::Kind::values) {
    if (data.movement_names.size() < 2) {
      throw_bad_input("there is one movement, of which none can be held out", "--split",
                      "name the column that tells movements apart (--roles COLUMN=movement), or "
                      "give another file by --test");
    }
    return draw_test_movements(data, wanted.share, RandomStream(arguments.seed).split("split"));
  }
  const RowsWith rows(file, wanted);
  std::vector<char> kept(held_out.size(), 0);
  for (std::size_t row = 0; row < data.rows(); ++row) {
    const auto movement = static_cast<std::size_t>(data.movement[row]);
    (rows.has(row) ? held_out : kept)[movement] = 1;
    if (held_out[movement] == 0 || kept[movement] == 0) continue;
    throw_bad_input(fmt::format("'{}' changes within movement '{}' (row {})", wanted.column,
                                data.movement_names[movement], row + 1),
                    "--split", "name a column that is the same all through a movement");
  }
  const auto count = static_cast<std::size_t>(std::ranges::count(held_out, 1));
  if (count == 0 || count == held_out.size()) {
    throw_bad_input(fmt::format("{} of {} movements have that value of '{}'", count,
                                held_out.size(), wanted.column),
                    "--split", "give a value that some movements have, not all");
  }
  return held_out;
}

// In the unit of the drive, or of a motor's torque.
bool has_recorded_gravity(const Dataset& data) {
  const Channel* gravity = data.find(Role::gravity_torque);
  if (gravity == nullptr) return false;
  const Channel* drive = data.find(Role::motor_torque);
  return drive == nullptr || drive->unit == gravity->unit ||
         (drive->unit == "V" && (gravity->unit == "N m" || gravity->unit == "N"));
}

void simulate(const SimulateArguments& arguments) {
  if (!arguments.out.empty()) make_output_folder(arguments.out);
  MotionSetup setup = arguments.setup;
  read_model(arguments, setup);
  read_body(arguments, setup);
  read_control(arguments, setup);
  read_refined(arguments, setup);
  const DataFile train = read_recording(arguments, setup, arguments.files);
  require_own_reference(arguments, train.data);
  std::optional<DataFile> test;
  if (!arguments.test.empty()) {
    const std::vector<std::filesystem::path> trains(arguments.files.begin(), arguments.files.end());
    user::require_apart(trains, arguments.test, "--test");
    test = read_recording(arguments, setup, {arguments.test});
  }
  read_unit(arguments, train.data, setup);
  if (arguments.gravity.empty() && has_recorded_gravity(train.data)) {
    setup.gravity = forward::kRecordedGravity;
  }
  const MotionRecord record = try_motion(train.data, test ? &test->data : nullptr, setup,
                                         held_out_movements(arguments, train));
  if (!arguments.out.empty()) {
    const std::filesystem::path folder = arguments.out;
    write_file(folder / "motion.json", write_motion_json(record));
    write_file(folder / "motion.html", motion_html(record));
    write_file(folder / "motion.csv", motion_csv(record));
  }
  fmt::print("{}", arguments.json ? write_motion_json(record) : motion_terminal(record));
}

void add_body_options(CLI::App& command, const std::shared_ptr<SimulateArguments>& arguments) {
  command.add_option("--inertia", arguments->inertia,
                     "kg m^2 (kg of a slide), or fit; not needed where the formula reads a");
  command.add_option("--gravity", arguments->gravity,
                     "the torque against gravity: a formula in q ('4.9*sin(q)'), recorded (the "
                     "column; the default where there is one), fit, or none");
  command.add_flag("--whole", arguments->setup.is_whole,
                   "the formula is the motor's whole torque, inertia and gravity in it");
  command
      .add_option("--motor-constant", arguments->motor_constant,
                  "of a motor under voltage, at the joint: N m/A and V s/rad")
      ->transform(real_number(0, 1e9, LowEnd::above));
  command.add_option("--resistance", arguments->resistance, "of a motor under voltage, ohm")
      ->transform(real_number(0, 1e9, LowEnd::above));
  command
      .add_option("--current-limit", arguments->most_current,
                  "of that motor's amplifier, A; without it there is none")
      ->transform(real_number(0, 1e9, LowEnd::above));
  command.add_option("--connected", arguments->setup.connected,
                     "a column: 0 where the motor is switched off and carries no current");
  CLI::Option* control = command.add_option(
      "--control", arguments->setup.control,
      "the drive as a law of q, v and columns (q_1: a row before): '40*(goal - q) - 2*v'");
  command.add_option("--limit", arguments->setup.limit,
                     "of the controller's output, a number or a formula of columns");
  command
      .add_option("--reference", arguments->reference,
                  "a column that a PD law follows, in SI like q")
      ->excludes(control);
  command.add_option("--kp", arguments->kp, "of the PD law: drive a unit of position")
      ->transform(real_number(0, 1e12));
  command.add_option("--kd", arguments->kd, "of the PD law: drive a unit of velocity")
      ->transform(real_number(0, 1e12));
}

}  // namespace

void add_simulate_command(CLI::App& app, ExitStatus& /*status*/) {
  CLI::App* command = app.add_subcommand(
      "simulate", "The motion that a formula predicts, against the recorded one");
  command->footer(
      "Example: tribench simulate '8.1*sgn_v + 14*v' joint.csv --inertia fit --gravity fit "
      "--split 0.25 --unit deg\n"
      "The drive is the column with the role motor_torque (N m, N; V with --motor-constant).\n"
      "In a formula q v a sgn_v tau_m g t d v_lag30 are the simulated joint's, other names "
      "columns.");
  auto arguments = std::make_shared<SimulateArguments>();
  command
      ->add_option("MODEL", arguments->model,
                   "a formula (states may be declared before it), or a file: fit --save, loop.json")
      ->required();
  command->add_option("DATA", arguments->files, "CSV files with time, position and a drive")
      ->required();
  add_data_options(*command, arguments->reading);
  add_body_options(*command, arguments);
  command->add_flag("--hold", arguments->setup.hold,
                    "the recorded drive keeps its value until the next row");
  command
      ->add_option("--horizon", arguments->setup.horizon_s,
                   "start again from the measured state every so many seconds; 0: never")
      ->transform(real_number(0, 1e9));
  command
      ->add_option("--refine", arguments->refine,
                   "fit to the simulated motion of the training movements: inertia, gravity, "
                   "motor, friction, all")
      ->delimiter(',')
      ->check(CLI::IsMember({"inertia", "gravity", "motor", "friction", "all"}));
  CLI::Option* test =
      command->add_option("--test", arguments->test, "another recording, held out as a whole");
  command
      ->add_option_function<std::string>(
          "--split",
          [arguments = arguments.get()](const std::string& text) {
            arguments->held_out = user::parse_held_out(text, "--split");
          },
          "hold out a share of the movements (0.25), drawn with the seed, or COLUMN=VALUE")
      ->excludes(test);
  command->add_option("--seed", arguments->seed, "same seed, same movements held out")
      ->transform(whole_number(0))
      ->capture_default_str();
  command->add_option("--unit", arguments->unit, "to read positions in: deg, mm");
  command
      ->add_option("--tolerance", arguments->setup.tolerance,
                   "error of one step, as a share of the movement's range and top speed")
      ->transform(real_number(1e-13, 0.1))
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "print JSON");
  command->add_option("--out", arguments->out,
                      "folder for motion.html, motion.json and motion.csv");
  command->callback([arguments] { simulate(*arguments); });
}

}  // namespace tribench
