// SPDX-License-Identifier: MIT
#include "algorithms/parfam/parfam.hpp"

#include <algorithm>
#include <cstdint>

#include "algorithms/parfam/original.hpp"
#include "algorithms/parfam/search.hpp"

namespace tribench {
namespace {

using parfam::Denominators;

class ParFam : public Regressor {
 public:
  explicit ParFam(const Parameters& parameters) : original_(parameters.text("mode") == "original") {
    const std::string& optimizer = parameters.text("optimizer");
    if (optimizer != "default") {
      search_.inner.optimizer = parfam::find_optimizer(optimizer);
      published_.optimizer = search_.inner.optimizer;
    }
    search_.inner.starts = static_cast<int>(parameters.integer("starts"));
    search_.inner.denominators = parameters.text("denominators") == "safe" ? Denominators::safe
                                 : parameters.text("denominators") == "constrained"
                                     ? Denominators::constrained
                                     : Denominators::free;
    search_.polynomial_degree = static_cast<int>(parameters.integer("polynomial_degree"));
    search_.functions = static_cast<int>(parameters.integer("functions"));
    search_.sample_rows = static_cast<std::size_t>(parameters.integer("sample_rows"));
    search_.refined = static_cast<std::size_t>(parameters.integer("refined"));
    const std::string& choice = parameters.text("choice");
    search_.choice = choice == "bic"                  ? parfam::Choice::bic
                     : choice == "description_length" ? parfam::Choice::description_length
                                                      : parfam::Choice::cross_validation;
    if (!parameters.text("family").empty()) {
      search_.family = parfam::parse_family(parameters.text("family"));
      published_.family = search_.family;
    }
    published_.big = parameters.text("grid") == "big";
  }

  FitResult fit(FitContext& context) const override {
    return original_ ? parfam::search_as_published(context, published_)
                     : parfam::search(context, search_);
  }

 private:
  bool original_;
  parfam::SearchOptions search_;
  parfam::OriginalOptions published_;
};

std::vector<ParameterSpec> specs() {
  const auto text = [](const char* name, const char* summary, const char* value,
                       std::vector<std::string> choices) {
    return ParameterSpec{name, summary, std::string(value), -1e308, 1e308, std::move(choices)};
  };
  return {
      text("mode", "ours: projected and sparse; original: as published", "ours",
           {"ours", "original"}),
      text("optimizer", "global search; default: multi_start in ours, basin_hopping in original",
           "default",
           {"default", "multi_start", "basin_hopping", "mlsl", "crs2", "esch", "isres", "direct_l",
            "ipopt"}),
      text(
          "denominators",
          "safe: 1 + q^2, without poles; constrained: 1 + q kept from 0 by Ipopt and proved; free: "
          "1 + q (mode ours)",
          "safe", {"safe", "constrained", "free"}),
      text("family",
           "the only family that is searched, as in '2/0 exp 2/0' or '3/0'; empty: a grid", "", {}),
      text("choice", "how the formula is chosen from the front (mode ours)", "bic",
           {"bic", "description_length", "cross_validation"}),
      text("grid", "small: 51 families; big: 589 (mode original)", "small", {"small", "big"}),
      {"starts", "starts a family (mode ours)", std::int64_t{16}, 1, 10000},
      {"polynomial_degree", "highest degree of best-subset polynomials (mode ours)",
       std::int64_t{5}, 1, 10},
      {"functions", "base functions at once (mode ours)", std::int64_t{1}, 0, 3},
      {"sample_rows", "rows the families are searched on (mode ours)", std::int64_t{500}, 20, 1e7},
      {"refined", "families made sparse on all rows (mode ours)", std::int64_t{6}, 0, 100},
  };
}

// More starts and families: two functions at once, a degree more, and denominators of both kinds by
// turns, for a safe one cannot have the pole that a law may have outside its data.
std::map<std::string, ParameterValue> widened(int round) {
  return {{"starts", std::int64_t{std::min(16 + 8 * round, 64)}},
          {"refined", std::int64_t{std::min(6 + 2 * round, 16)}},
          {"functions", std::int64_t{round < 2 ? 1 : 2}},
          {"polynomial_degree", std::int64_t{round < 2 ? 5 : 6}},
          {"denominators", std::string(round % 2 == 1 ? "free" : "safe")}};
}

}  // namespace

AlgorithmEntry parfam_entry() {
  return {"parfam",
          "ParFam: parametric families by continuous optimisation",
          specs(),
          false,
          [](const Parameters& parameters, const MakeMethod&) -> std::unique_ptr<Regressor> {
            return std::make_unique<ParFam>(parameters);
          },
          widened};
}

}  // namespace tribench
