// SPDX-License-Identifier: MIT
#include "algorithms/pysr/pysr.hpp"

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

}  // namespace

AlgorithmEntry pysr_entry() {
  return {"pysr", "evolution on islands after PySR, with fitted constants and guided growth",
          pysr::parameter_specs(), false, make_pysr};
}

}  // namespace tribench
