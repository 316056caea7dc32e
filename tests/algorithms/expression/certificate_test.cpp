// SPDX-License-Identifier: MIT
#include "algorithms/expression/certificate.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/singularity.hpp"
#include "algorithms/expression/text.hpp"
#include "foundation/error.hpp"
#include "tests/algorithms/expression/containment.hpp"
#include "tests/algorithms/expression/proof_formulas.hpp"

namespace tribench::certificate_test {
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

TEST(Certificate, IsAcceptedByTheChecker) {
  const std::string text = certify(kFormula, kBox);
  const CertificateCheck check = check_certificate(text);
  EXPECT_TRUE(check.accepted) << check.reason;
  EXPECT_EQ(check.box, kBox);
  EXPECT_GE(check.pieces, 3U);
}

TEST(Certificate, TellsHowFarItsCheckIs) {
  const std::string text = certify(kFormula, kBox);
  const std::size_t entries = Json::parse(text)["entries"].size();
  std::size_t told = 0;
  check_certificate(text, [&](std::size_t all) {
    EXPECT_EQ(all, entries);
    ++told;
  });
  EXPECT_EQ(told, entries);
}

TEST(Certificate, ExistsForFormulasThatOnlySharperBoundsProveAtOnce) {
  for (const char* formula :
       {"1/(v^2 - 0.6*v + 0.09001)", "1/(v*v - 2*v + 2)", "1/(2 + sin(v*g))", "abs(v)^1.5",
        "1/(cos(v) + 0.4262)", "1/(v^4 - v^2 + 0.26)", "log(1 + exp(v))", "1/(1 + exp(-40*v))",
        "1/(sgn(v) + 0.5)", "exp(-g^2)", "(v + 3)^g", "1/(g*sgn_g + abs(v) + 0.01)",
        "sqrt(2*v + 4)", "v/(v + 2*sgn_v + 4.5)"}) {
    const CertificateCheck check = check_certificate(certify(formula, kBox));
    EXPECT_TRUE(check.accepted) << formula << ": " << check.reason;
  }
}

TEST(Certificate, CannotBeWrittenForASingularFormula) {
  for (const char* formula : {"1/v", "1/(v^2 - 2)", "sqrt(v)", "exp(g^2)", "log(abs(v))"}) {
    EXPECT_EQ(certify(formula, kBox), "") << formula;
  }
}

TEST(Certificate, IsRejectedWhateverFieldIsTamperedWith) {
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

TEST(Certificate, CoversLimitsAndDissipation) {
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

TEST(Certificate, CannotBeWrittenForAPropertyThatFails) {
  for (const auto& [formula, claim] : {std::pair{std::string("3*sgn_v - 2*v"), kDissipative},
                                       {"v + 0.001*g", kDissipative},
                                       {"1 + v", kDissipative},
                                       {"v/(v^2 + 1)", bounded_by(0.49)},
                                       {"g", bounded_by(59)}}) {
    EXPECT_EQ(certify(formula, kBox, claim), "") << formula;
  }
}

TEST(Certificate, CheckerAcceptsNoFalseClaimHoweverTheBoxIsCut) {
  // A certificate for another formula, relabelled.
  Json json = Json::parse(certify("1/(v^2 + 1)", "v=-2:2"));
  json["formula"] = "1/(v^2 - 1)";
  EXPECT_FALSE(check_certificate(forge(json)).accepted);
}

// Each sign that is looked at makes three cells of one: 3^40 of them are no certificate's.
TEST(Certificate, OfMoreCellsThanEntriesIsRejectedBeforeTheyAreMade) {
  std::string formula = "abs(x0)";
  std::string box = "x0=-1:1";
  for (int k = 1; k < 40; ++k) {
    formula += fmt::format(" + abs(x{})", k);
    box += fmt::format(",x{}=-1:1", k);
  }
  nlohmann::ordered_json json = {{"format", "tribench certificate 2"},
                                 {"formula", formula},
                                 {"box", box},
                                 {"claim", "finite"},
                                 {"entries", nlohmann::json::array()}};
  json["digest"] = certificate_digest(json.dump());
  const CertificateCheck check = check_certificate(json.dump());
  EXPECT_FALSE(check.accepted);
  EXPECT_EQ(check.reason, "the entries are fewer than the cells of the box");
  NamedBox named = parse_box(box);
  EXPECT_FALSE(write_certificate(parse_over(formula, named), named));
}

// A box of its own for each of thousands of cuts within one another took 10 GB.
TEST(Certificate, OfManyCutsWithinOneAnotherTakesNoMemoryForEach) {
  constexpr int kInputs = 20'000;
  std::string box = "x0=1:2";
  for (int k = 1; k < kInputs; ++k) box += fmt::format(",x{}=1:2", k);
  Json json = {{"format", "tribench certificate 2"},
               {"formula", "x0 + 1"},
               {"box", box},
               {"claim", "finite"},
               {"entries", Json::array()}};
  for (int cut = 0; cut < 4000; ++cut) {
    json["entries"].push_back({{"cut", {"x0", 2 - 0.0001 * (cut + 1)}}});
  }
#ifdef TRIBENCH_SANITIZED
  GTEST_SKIP() << "the sanitizer's shadow memory is too large to be limited";
#endif
  struct rlimit memory {};
  getrlimit(RLIMIT_DATA, &memory);
  struct rlimit little = memory;
  little.rlim_cur = 1U << 30;
  setrlimit(RLIMIT_DATA, &little);
  const CertificateCheck check = check_certificate(forge(json));
  setrlimit(RLIMIT_DATA, &memory);
  EXPECT_EQ(check.reason, "the entries end before the box is covered");
}

// 1/x10000 is not finite on x10000=-1:1; a variable of 16 bits that folded input 65536 onto input 0
// proved it.
TEST(Certificate, NamesEveryInputItClaimsOrIsRefused) {
  std::string box;
  for (int i = 0; i <= 65'536; ++i) box += "y" + std::to_string(i) + "=1:2,";
  box += "x=-1:1";
  EXPECT_THROW(parse_box(box), Error);
  Json json = Json::parse(certify("1/x", "x=1:2"));
  json["box"] = box;
  json["formula"] = "1/x + 0*y65536";
  const CertificateCheck check = check_certificate(forge(json));
  EXPECT_FALSE(check.accepted);
  EXPECT_EQ(check.reason.find("cannot be read"), std::string::npos) << check.reason;

  std::string sum = "0";
  for (int i = 0; i < 65'536; ++i) sum += " + y" + std::to_string(i);
  std::vector<std::string> names;
  EXPECT_EQ(columns_used(parse_collecting_names(sum, names)), kMaxInputs);
  EXPECT_THROW(parse_collecting_names(sum + " + 1/x", names), Error);
  EXPECT_THROW(Node::input(kMaxInputs), Error);
}

TEST(Certificate, IsReadByTheCheckerAsTheProverWroteIt) {
  RandomStream random(key_of("two parsers"));
  const std::vector<std::string> names = {"v", "g", "t"};
  for (int trial = 0; trial < 5000; ++trial) {
    const Expression formula = testing::random_formula(random, {.inputs = 3});
    const std::string text = print(formula, names);
    ClaimedBox box = read_claimed_box("v=-1:1,g=-1:1,t=-1:1");
    const ClaimedFormula claimed = read_claimed_formula(text, box);
    ASSERT_EQ(claimed.size(), formula.size()) << text;
    for (std::size_t i = 0; i < claimed.size(); ++i) {
      const Node& node = formula.node(i);
      ASSERT_EQ(claimed[i].op, node.op) << text;
      ASSERT_EQ(claimed[i].value, node.value) << text;
      if (node.is_variable()) ASSERT_EQ(claimed[i].input, node.variable) << text;
    }
  }
}

TEST(Certificate, IsRejectedWhereItsFormulaOrBoxIsNone) {
  for (const char* formula : {"", "v +", "(v", "v)", "v v", "exp v", "exp", "w", "sgn_w", "2v",
                              "v ** 2", "inf", "nan", "v#"}) {
    ClaimedBox box = read_claimed_box("v=-1:1");
    EXPECT_THROW(read_claimed_formula(formula, box), Error) << formula;
  }
  ClaimedBox box = read_claimed_box("v=-1:1");
  EXPECT_THROW(read_claimed_formula(std::string(100'000, '('), box), Error);
  for (const char* text : {"v", "v=1", "v=1:0", "v=0:inf", "v=0:nan", "v=0:1,v=0:1", "1=0:1",
                           "v=0:1,sgn_v=-1:1", "v=0:1x", "x+y=0:1"}) {
    EXPECT_THROW(read_claimed_box(text), Error) << text;
  }
}

TEST(InputBox, ASignBesideItsInputIsLeftOutUnlessItSaysLess) {
  for (const char* text : {"sgn_v=-1:1,v=-2:2", "v=-2:2,sgn_v=-1:1", "v=-2:2,sgn_v=-5:5"}) {
    NamedBox box = parse_box(text);
    EXPECT_EQ(print_box(box), "v=-2:2") << text;
    const Expression formula = parse_over("1/(1 + v*sgn_v)", box);
    EXPECT_EQ(prove_free(formula, box.ranges).verdict, Verdict::proved_free) << text;
  }
  EXPECT_EQ(print_box(parse_box("v=1:2,sgn_v=1:1")), "v=1:2");
  EXPECT_EQ(print_box(parse_box("sgn_v=0:1")), "sgn_v=0:1") << "nobody's sign";
  for (const char* text : {"v=-2:2,sgn_v=1:1", "v=-2:2,sgn_v=-1:0", "v=0:2,sgn_v=1:1"}) {
    EXPECT_THROW(parse_box(text), Error) << text;
  }
}

TEST(Certificate, OfGarbageIsRejectedAndTheReasonCanBePrinted) {
  const std::string good = certify(kFormula, kBox);
  RandomStream random(key_of("garbage"));
  std::vector<std::string> all = {std::string(100'000, '['), "\xff", ""};
  for (int trial = 0; trial < 500; ++trial) {
    std::string text = good;
    for (int change = 0; change < 3; ++change) {
      text[random.below(text.size())] = static_cast<char>(random.below(256));
    }
    all.push_back(text);
  }
  for (const std::string& text : all) {
    if (text == good) continue;
    const CertificateCheck check = check_certificate(text);
    EXPECT_FALSE(check.accepted) << text;
    EXPECT_NO_THROW(Json(check.reason).dump()) << check.reason;  // throws on what is no UTF-8
  }
}

// The checker's bounds are its own code: they get the prover's property test.
TEST(Certificate, CheckerBoundsContainEverySampledValue) {
  RandomStream random(key_of("checker bounds"));
  int bounded = 0;
  for (int trial = 0; trial < 6000; ++trial) {
    const Expression formula = testing::random_formula(random, {.inputs = 3});
    const testing::Box box = testing::random_box(random, 3);
    Piece piece;
    for (const Interval& side : box) piece.push_back({side.low, side.high});
    const auto columns = testing::sample_box(random, box);
    for (std::size_t i = 0; i < formula.size(); ++i) {
      const std::string text = print(subtree(formula, i), std::vector<std::string>{"v", "g", "t"});
      ClaimedBox claimed = read_claimed_box("v=-1:1,g=-1:1,t=-1:1");  // its names
      const auto bounds = piece_bounds(read_claimed_formula(text, claimed), piece);
      if (!bounds) continue;
      ++bounded;
      ASSERT_EQ(testing::count_escapes(subtree(formula, i), columns, {bounds->low, bounds->high}),
                0)
          << text;
    }
  }
  EXPECT_GT(bounded, 20000);
}

TEST(Certificate, MostProvedFormulasHaveOne) {
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
}  // namespace tribench::certificate_test
