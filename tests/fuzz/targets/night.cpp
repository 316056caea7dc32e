// SPDX-License-Identifier: MIT
//
// A night's record out of a store, and a blessing: refused with a place, or read; a night that was
// read is written as text that reads the same. Half of the tries give the text the checksum that
// fits, so that what is inside is read too.
#include "reports/night.hpp"
#include "foundation/output_file.hpp"
#include "foundation/scratch_folder.hpp"
#include "reports/night_store.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace {

using namespace tribench;

void try_night(std::string_view text) {
  Night night;
  fuzz::reads([&] { read_night(text, "a.night", false); });
  if (!fuzz::reads([&] { night = read_night(text, "a.night"); })) return;
  const std::string written = print_night(night);
  fuzz::expect(print_night(read_night(written, "b.night")) == written,
               "what is written reads as something else:\n" + written);
}

}  // namespace

TRIBENCH_FUZZ_TARGET(night) {
  try_night(input);
  try_night(night_text(input));
  static const ScratchFolder folder;
  static const NightStore store(folder.path());
  write_file(folder.path() / "blessings" / "2026.json", std::string(input));
  fuzz::reads([&] { store.base(); });
}
