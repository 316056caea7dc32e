// SPDX-License-Identifier: MIT
//
// A world's limits either are refused with a place, or are written again as a text that reads the
// same; a world's folder whose sealed file was changed is refused too.
#include "foundation/output_file.hpp"
#include "foundation/scratch_folder.hpp"
#include "harness/exploration/world_folder.hpp"
#include "tests/fuzz/fuzz_target.hpp"

TRIBENCH_FUZZ_TARGET(world) {
  using namespace tribench;
  MotionLimits limits;
  if (fuzz::reads([&] { limits = read_limits(input, "limits.json"); })) {
    const std::string written = limits_json(limits);
    fuzz::expect(limits_json(read_limits(written, "written.json")) == written,
                 "what is written reads as something else:\n" + written);
  }
  static const ScratchFolder folder;
  write_file(folder.path() / "sealed.json", std::string(input));
  write_file(folder.path() / "world.json", std::string(input));
  fuzz::reads([&] { WorldFolder(folder.path()).reveal(); });
}
