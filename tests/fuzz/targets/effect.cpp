// SPDX-License-Identifier: MIT
//
// An effect file either is refused with a place, or is written again as a file that reads the same.
#include "algorithms/effects/effect_library.hpp"
#include "tests/fuzz/fuzz_target.hpp"

TRIBENCH_FUZZ_TARGET(effect) {
  using namespace tribench;
  std::vector<loop::EffectFamily> effects;
  const fuzz::MemoryFile file(input);
  if (!fuzz::reads([&] { effects = loop::read_effects(file.path()); })) return;
  const std::string written = loop::write_effects(effects);
  const fuzz::MemoryFile again(written);
  fuzz::expect(loop::write_effects(loop::read_effects(again.path())) == written,
               "what is written reads as something else:\n" + written);
}
