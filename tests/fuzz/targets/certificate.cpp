// SPDX-License-Identifier: MIT
//
// A certificate is accepted only if what it claims is true: its digest is made to fit (it is
// against accidents), and whatever is accepted then is held against values of the formula in its
// box.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "algorithms/expression/certificate.hpp"
#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/text.hpp"
#include "tests/fuzz/box_samples.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace {

using namespace tribench;
using Json = nlohmann::ordered_json;

constexpr std::size_t kPointsChecked = 64;

// The text with the digest that its content has; as it is where it is no JSON object.
std::string with_fitting_digest(std::string_view text) {
  Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) return std::string(text);
  json.erase("digest");
  try {
    json["digest"] = certificate_digest(json.dump());
    return json.dump();
  } catch (const Json::exception&) {  // no UTF-8
    return std::string(text);
  }
}

void expect_true(const Json& certificate) {
  NamedBox box = parse_box(certificate.at("box").get<std::string>());
  const Expression formula = parse_over(certificate.at("formula").get<std::string>(), box);
  const Json& claim = certificate.at("claim");
  Evaluator evaluator;
  for (const std::vector<double>& point : fuzz::samples_of(box.ranges, kPointsChecked)) {
    const double value = evaluator.evaluate_at(formula, point);
    fuzz::expect(std::isfinite(value), "accepted, and not finite: " + certificate.dump());
    if (!claim.is_object()) continue;
    if (claim.contains("bounded")) {
      fuzz::expect(std::abs(value) <= claim["bounded"].get<double>(),
                   "accepted, and beyond its limit: " + certificate.dump());
    } else {
      const auto velocity =
          std::ranges::find(box.names, claim.at("dissipative").get<std::string>());
      fuzz::expect(velocity != box.names.end(), "accepted, for a velocity that is no input");
      const auto place = static_cast<std::size_t>(velocity - box.names.begin());
      fuzz::expect(value * point[place] >= 0,
                   "accepted, and drives the joint: " + certificate.dump());
    }
  }
}

}  // namespace

TRIBENCH_FUZZ_TARGET(certificate) {
  check_certificate(input);
  const std::string text = with_fitting_digest(input);
  if (check_certificate(text).accepted) expect_true(Json::parse(text));
}
