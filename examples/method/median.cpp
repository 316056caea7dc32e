// SPDX-License-Identifier: MIT
//
// A whole method: the median of the target. Under tribench's command line, in a program of its own;
// built and run by the tests.
#include <algorithm>
#include <memory>
#include <vector>

#include "algorithms/registry.hpp"
#include "harness/cli/program.hpp"

namespace {

class Median : public tribench::Regressor {
 public:
  tribench::FitResult fit(tribench::FitContext& context) const override {
    std::vector<double> values(context.data.target.begin(), context.data.target.end());
    std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2),
                     values.end());
    tribench::FitResult result;
    result.front.push_back(tribench::Expression::constant(values[values.size() / 2]));
    return result;
  }
};

std::unique_ptr<tribench::Regressor> make_median(const tribench::Parameters&,
                                                 const tribench::MakeMethod&) {
  return std::make_unique<Median>();
}

}  // namespace

int main(int argc, char** argv) {
  tribench::Registry registry;
  registry.add({"median", "the median of the target", {}, true, make_median});
  return tribench::run_program(argc, argv, registry);
}
