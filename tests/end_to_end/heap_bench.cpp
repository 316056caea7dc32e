// SPDX-License-Identifier: MIT
//
// A loop that asks for memory and gives it back, in a program whose heap has been used before: by
// PLANTED_PIECES pieces of all sizes, as reading another machine leaves them.
#include <benchmark/benchmark.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace {

bool use_heap(int pieces) {
  std::vector<std::unique_ptr<std::string>> texts;
  for (int k = 0; k < pieces; ++k) {
    texts.push_back(
        std::make_unique<std::string>(static_cast<std::size_t>(20 + k * 37 % 3000), 'x'));
  }
  static std::vector<std::unique_ptr<std::string>> kept;  // every third; the rest is given back
  for (std::size_t k = 0; k < texts.size(); k += 3) kept.push_back(std::move(texts[k]));
  return true;
}
volatile int pieces =
    PLANTED_PIECES;  // not known to the compiler: both programs have the same code
const bool kIsUsed = use_heap(pieces);

void names(benchmark::State& state) {
  std::map<int, std::string> by_number;
  for (int k = 0; k < 200; ++k) by_number[5 * k] = std::string(30, 'y');
  for (auto _ : state) {
    for (int k = 0; k < 2000; ++k) {
      by_number[k * 7919 % 1009] = std::string(static_cast<std::size_t>(20 + k % 90), 'z');
      if (k % 3 == 0) by_number.erase(k * 31 % 1009);
    }
    benchmark::DoNotOptimize(by_number);
  }
}
BENCHMARK(names);
BENCHMARK(names)->Name("names_again");

}  // namespace
