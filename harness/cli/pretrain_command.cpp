// SPDX-License-Identifier: MIT
//
// tribench pretrain: trains uDSR's policy on formulas and friction laws and writes its weights.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "algorithms/udsr/pretraining.hpp"
#include "foundation/json_text.hpp"
#include "foundation/output_file.hpp"
#include "foundation/standard_streams.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/number_options.hpp"

namespace tribench {
namespace {

struct Arguments {
  udsr::PretrainingOptions options;
  std::string out;
  bool encoder = false;
  bool json = false;
};

void show_progress(double done) {
  if (isatty(STDERR_FILENO) == 0) return;
  print_message(fmt::format("\rpre-training {:3.0f} %", 100 * done));
  if (done >= 1) print_message("\n");
}

void run(const Arguments& arguments) {
  try_output_file(arguments.out);
  const udsr::TokenLibrary library = udsr::pretraining_library();
  udsr::Policy policy(library, RandomStream(arguments.options.seed));
  std::optional<udsr::DataEncoder> encoder;
  if (arguments.encoder) encoder.emplace(RandomStream(arguments.options.seed).split("encoder"));
  udsr::DataEncoder* const trained = encoder ? &*encoder : nullptr;
  const udsr::WeightsProvenance provenance =
      udsr::pretrain(policy, trained, arguments.options, show_progress);
  write_file(arguments.out, udsr::write_weights(policy, trained, provenance));
  if (arguments.json) {
    fmt::print("{}\n", write_json(nlohmann::json({{"file", arguments.out},
                                                  {"sequences", provenance.sequences},
                                                  {"loss_per_token", provenance.loss_per_token}})));
  } else {
    fmt::print("{}: trained on {} formulas, {:.3f} nats a token on held-out ones\n", arguments.out,
               provenance.sequences, provenance.loss_per_token);
  }
}

}  // namespace

void add_pretrain_command(CLI::App& app, ExitStatus& /*status*/) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("pretrain", "Train uDSR's policy before it sees any data");
  command->footer("Example: tribench pretrain --sequences 50000 --out weights.json");
  command->add_option("--out", arguments->out, "the weight file to write")->required();
  command->add_option("--seed", arguments->options.seed, "of the corpus and the first weights")
      ->transform(whole_number(0))
      ->capture_default_str();
  command->add_option("--sequences", arguments->options.sequences, "formulas in the corpus")
      ->transform(whole_number(100, 10'000'000))
      ->capture_default_str();
  command->add_option("--epochs", arguments->options.epochs, "passes over the corpus")
      ->transform(whole_number(1, 1000))
      ->capture_default_str();
  command->add_flag("--encoder", arguments->encoder,
                    "train a data encoder along; used by udsr with encoder = true");
  command->add_flag("--json", arguments->json, "what was done, as JSON");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace tribench
