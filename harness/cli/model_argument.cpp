// SPDX-License-Identifier: MIT
#include "harness/cli/model_argument.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "foundation/text.hpp"

namespace tribench {

nlohmann::json model_argument(const std::string& model) {
  std::error_code is_no_path;  // a long formula is none
  if (!std::filesystem::is_regular_file(model, is_no_path)) {
    if (model.ends_with(".json")) throw_bad_input("there is no such file", model);
    return {{"formula", model}};
  }
  std::string reason;
  const nlohmann::json json = read_json<nlohmann::json>(read_file(model), &reason);
  if (!json.is_object() || !json.contains("formula") || !json["formula"].is_string()) {
    throw_bad_input("this is no model: " + (reason.empty() ? "it has no formula" : reason), model,
                    "give a formula, or what 'tribench fit --json' prints");
  }
  return json;
}

}  // namespace tribench
