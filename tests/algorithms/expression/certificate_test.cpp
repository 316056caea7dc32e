// SPDX-License-Identifier: MIT
#include "algorithms/expression/certificate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/singularity.hpp"
#include "algorithms/expression/text.hpp"
#include "tests/algorithms/expression/containment.hpp"
#include "tests/algorithms/expression/proof_formulas.hpp"

namespace tribench {
namespace {

using Json = nlohmann::ordered_json;

std::string certify(const std::string& formula, const std::string& box,
                    const CertificateClaim& claim = {}) {
  NamedBox named = parse_box(box);
  const Expression parsed = parse_over(formula, named);
  return write_certificate(parsed, named, 2000, claim).value_or("");
}

CertificateClaim bounded_by(double limit) { return {CertificateClaim::Kind::bounded, limit, ""}; }
const CertificateClaim kDissipative = {CertificateClaim::Kind::dissipative, 0, "v"};

// The digest guards against accidents only: a forger recomputes it.
std::string forge(Json json) {
  json.erase("digest");
  json["digest"] = certificate_digest(json.dump());
  return json.dump(1);
}

const std::string kFormula = "v/(v^2 - 2*v + 2) + sqrt(v*sgn_v)*g";
const std::string kBox = "v=-2:2,g=-60:60";

TEST(Certificate, is_accepted_by_the_checker) {
  const std::string text = certify(kFormula, kBox);
  const CertificateCheck check = check_certificate(text);
  EXPECT_TRUE(check.accepted) << check.reason;
  EXPECT_EQ(check.box, kBox);
  EXPECT_GE(check.pieces, 3U);
}

TEST(Certificate, exists_for_formulas_that_only_sharper_bounds_prove_at_once) {
  for (const char* formula :
       {"1/(v^2 - 0.6*v + 0.09001)", "1/(v*v - 2*v + 2)", "1/(2 + sin(v*g))", "abs(v)^1.5",
        "1/(cos(v) + 0.4262)", "1/(v^4 - v^2 + 0.26)", "log(1 + exp(v))", "1/(1 + exp(-40*v))",
        "1/(sgn(v) + 0.5)", "exp(-g^2)", "(v + 3)^g", "1/(g*sgn_g + abs(v) + 0.01)",
        "sqrt(2*v + 4)", "v/(v + 2*sgn_v + 4.5)"}) {
    const CertificateCheck check = check_certificate(certify(formula, kBox));
    EXPECT_TRUE(check.accepted) << formula << ": " << check.reason;
  }
}

TEST(Certificate, cannot_be_written_for_a_singular_formula) {
  for (const char* formula : {"1/v", "1/(v^2 - 2)", "sqrt(v)", "exp(g^2)", "log(abs(v))"}) {
    EXPECT_EQ(certify(formula, kBox), "") << formula;
  }
}

TEST(Certificate, is_rejected_whatever_field_is_tampered_with) {
  const Json good = Json::parse(certify(kFormula, kBox));
  std::vector<std::pair<std::string, Json>> tampered;
  const auto tamper = [&](const std::string& what, auto change) {
    Json json = good;
    change(json);
    tampered.emplace_back(what, json);
  };
  std::size_t cut = 0;
  while (!good["entries"][cut].contains("cut")) ++cut;
  std::size_t piece = 0;
  while (!good["entries"][piece].contains("piece")) ++piece;
  tamper("claim", [](Json& j) { j["claim"] = {{"dissipative", "v"}}; });
  tamper("limit", [](Json& j) { j["claim"] = {{"bounded", 20}}; });
  tamper("unknown claim", [](Json& j) { j["claim"] = {{"pretty", "v"}}; });
  tamper("claim of another input", [](Json& j) { j["claim"] = {{"dissipative", "w"}}; });
  tamper("no claim", [](Json& j) { j["claim"] = nullptr; });
  tamper("format", [](Json& j) { j["format"] = "tribench certificate 1"; });
  tamper("formula", [](Json& j) { j["formula"] = "v/(v^2 - 2*v + 1) + sqrt(v*sgn_v)*g"; });
  tamper("formula, broken", [](Json& j) { j["formula"] = "v/("; });
  tamper("wider box", [](Json& j) { j["box"] = "v=-2:3,g=-60:60"; });
  tamper("other input", [](Json& j) { j["box"] = "w=-2:2,g=-60:60"; });
  tamper("moved cut", [&](Json& j) { j["entries"][cut]["cut"][1] = 0.987; });
  tamper("cut of another input", [&](Json& j) { j["entries"][cut]["cut"][0] = "w"; });
  tamper("cut outside", [&](Json& j) { j["entries"][cut]["cut"][1] = 1e6; });
  tamper("piece", [&](Json& j) { j["entries"][piece]["piece"]["v"][1] = 0.123; });
  tamper("lacking side", [&](Json& j) { j["entries"][piece]["piece"].erase("g"); });
  tamper("narrower bounds", [&](Json& j) {
    const double high = j["entries"][piece]["bounds"][1];
    j["entries"][piece]["bounds"][1] = std::nextafter(high, -1e300);
  });
  tamper("infinite bounds", [&](Json& j) { j["entries"][piece]["bounds"][1] = nullptr; });
  tamper("missing entry", [](Json& j) { j["entries"].erase(j["entries"].size() - 1); });
  tamper("entry too many", [](Json& j) { j["entries"].push_back(j["entries"].back()); });
  tamper("entries swapped",
         [&](Json& j) { std::swap(j["entries"][piece], j["entries"][j["entries"].size() - 1]); });
  tamper("no entries", [](Json& j) { j["entries"] = Json::array(); });
  tamper("foreign field", [](Json& j) { j["note"] = "trust me"; });
  for (const auto& [what, json] : tampered) {
    EXPECT_FALSE(check_certificate(json.dump()).accepted) << what;
    const CertificateCheck check = check_certificate(forge(json));
    EXPECT_FALSE(check.accepted) << what << ", with its digest forged";
    EXPECT_FALSE(check.reason.empty());
  }
  EXPECT_FALSE(check_certificate("").accepted);
  EXPECT_FALSE(check_certificate("[1, 2]").accepted);
  EXPECT_TRUE(check_certificate(forge(good)).accepted);
}

TEST(Certificate, covers_limits_and_dissipation) {
  const std::string stribeck = "(3 + 2*exp(-(v/0.1)^2))*sgn_v + 4*v + 0.05*g*sgn_v*sgn_g";
  for (const auto& [formula, claim] : {std::pair{stribeck, kDissipative},
                                       {stribeck, bounded_by(20)},
                                       {"v - 0.1*v^2*sgn_v", kDissipative},
                                       {"v/(v^2 + 1)", bounded_by(0.51)},
                                       {"2*v", kDissipative},
                                       {"0*g", kDissipative}}) {
    const CertificateCheck check = check_certificate(certify(formula, kBox, claim));
    EXPECT_TRUE(check.accepted) << formula << ": " << check.reason;
  }
}

TEST(Certificate, cannot_be_written_for_a_property_that_fails) {
  for (const auto& [formula, claim] : {std::pair{std::string("3*sgn_v - 2*v"), kDissipative},
                                       {"v + 0.001*g", kDissipative},
                                       {"1 + v", kDissipative},
                                       {"v/(v^2 + 1)", bounded_by(0.49)},
                                       {"g", bounded_by(59)}}) {
    EXPECT_EQ(certify(formula, kBox, claim), "") << formula;
  }
}

TEST(Certificate, checker_accepts_no_false_claim_however_the_box_is_cut) {
  // A certificate for another formula, relabelled.
  Json json = Json::parse(certify("1/(v^2 + 1)", "v=-2:2"));
  json["formula"] = "1/(v^2 - 1)";
  EXPECT_FALSE(check_certificate(forge(json)).accepted);
}

// The checker's bounds are its own code: they get the prover's property test.
TEST(Certificate, checker_bounds_contain_every_sampled_value) {
  RandomStream random(key_of("checker bounds"));
  int bounded = 0;
  for (int trial = 0; trial < 6000; ++trial) {
    const Expression formula = testing::random_formula(random, {.inputs = 3});
    const testing::Box box = testing::random_box(random, 3);
    Piece piece;
    for (const Interval& side : box) piece.push_back({side.low, side.high});
    const auto columns = testing::sample_box(random, box);
    for (std::size_t i = 0; i < formula.size(); ++i) {
      const auto bounds = piece_bounds(formula.subtree(i), piece);
      if (!bounds) continue;
      ++bounded;
      ASSERT_EQ(testing::count_escapes(formula.subtree(i), columns, {bounds->low, bounds->high}), 0)
          << print(formula.subtree(i), std::vector<std::string>{"v", "g", "t"});
    }
  }
  EXPECT_GT(bounded, 20000);
}

TEST(Certificate, most_proved_formulas_have_one) {
  RandomStream random(key_of("certificates"));
  int proved = 0;
  int certified = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    const Expression formula = testing::random_formula(random, {.inputs = 2});
    const NamedBox box = {{"v", "g"}, {{-2, 2}, {-1, 3}}};
    if (prove_free(formula, box.ranges).verdict != Verdict::proved_free) continue;
    ++proved;
    const auto certificate = write_certificate(formula, box, 3000);
    if (!certificate) continue;
    ++certified;
    const CertificateCheck check = check_certificate(*certificate);
    ASSERT_TRUE(check.accepted) << check.reason << " " << check.formula;
  }
  std::printf("%d proved, %d with a certificate of at most 3000 pieces\n", proved, certified);
  EXPECT_GT(certified, proved * 0.95);
}

}  // namespace
}  // namespace tribench
