// SPDX-License-Identifier: MIT
//
// A sum over threads: with a race (`race`), or by parts that are joined after a barrier
// (`barrier`).
#include <cstdio>
#include <string_view>
#include <vector>

int main(int argc, char** argv) {
  const bool is_race = argc > 1 && std::string_view(argv[1]) == "race";
  constexpr int kCount = 1000;
  std::vector<long> squares(kCount);
  long sum = 0;
#pragma omp parallel for schedule(static) num_threads(4)
  for (int i = 0; i < kCount; ++i) {
    squares[static_cast<std::size_t>(i)] = static_cast<long>(i) * i;
    if (is_race) sum += i;
  }
  for (const long square : squares) sum += square;
  std::printf("%ld\n", sum);
  return 0;
}
