// SPDX-License-Identifier: MIT
#include "algorithms/pysr/pysr.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "algorithms/pysr/options.hpp"
#include "algorithms/pysr/search.hpp"

namespace tribench {
namespace {

class Pysr : public Regressor {
 public:
  explicit Pysr(pysr::Options options) : options_(std::move(options)) {}
  FitResult fit(FitContext& context) const override { return pysr::search(options_, context); }

 private:
  pysr::Options options_;
};

std::unique_ptr<Regressor> make_pysr(const Parameters& parameters, const MakeMethod&) {
  return std::make_unique<Pysr>(pysr::options_from(parameters));
}

// More islands, longer formulas, and more epochs before an island that finds nothing is given up.
std::map<std::string, ParameterValue> widened(int round) {
  const auto grown = [round](int from, int step, int most) {
    return ParameterValue(std::int64_t{std::min(from + step * round, most)});
  };
  return {{"populations", grown(4, 2, 16)},
          {"patience", grown(2, 1, 8)},
          {"iterations", grown(40, 20, 400)},
          {"max_size", grown(40, 4, 60)}};
}

}  // namespace

AlgorithmEntry pysr_entry() {
  return {"pysr",
          "evolution on islands after PySR, with fitted constants and guided growth",
          pysr::parameter_specs(),
          false,
          make_pysr,
          widened};
}

}  // namespace tribench
