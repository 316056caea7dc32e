// SPDX-License-Identifier: MIT
//
// A policy's weight file is refused with its place, or read; so too where its hash is made to fit
// and its thousands of parameters, of which an input gives the number alone, are filled in.
#include <nlohmann/json.hpp>

#include "algorithms/udsr/weights.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace {

using namespace tribench;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxParameters = 20'000;

const udsr::TokenLibrary& library() {
  static const udsr::TokenLibrary kLibrary(find_operator_set("paper"), 2, {});
  return kLibrary;
}

void try_weights(std::string_view text) {
  fuzz::reads([&] { udsr::read_encoder(text, "weights.json"); });
  fuzz::reads([&] {
    udsr::Policy policy(library(), RandomStream(1));
    udsr::read_weights(text, "weights.json", policy);
  });
}

void fill_in(Json& parameters) {
  if (!parameters.is_number_unsigned() || parameters > kMaxParameters) return;
  const Json count = parameters;
  parameters = Json::array();
  for (std::size_t i = 0; i < count; ++i) parameters.push_back(0.5);
}

}  // namespace

TRIBENCH_FUZZ_TARGET(weights) {
  try_weights(input);
  Json file = Json::parse(input, nullptr, false);
  if (!file.is_object() || !file.contains("tokens") || !file.contains("parameters")) return;
  fill_in(file["parameters"]);
  try {
    file["hash"] =
        udsr::weights_hash(file["tokens"], file["parameters"], file.value("encoder", Json()));
    try_weights(file.dump());
  } catch (const Json::exception&) {  // no UTF-8
  }
}
