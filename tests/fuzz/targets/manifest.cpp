// SPDX-License-Identifier: MIT
//
// A measured set's manifest either is refused with a place or is read.
#include "problems/measured/manifest.hpp"
#include "tests/fuzz/fuzz_target.hpp"

TRIBENCH_FUZZ_TARGET(manifest) {
  tribench::fuzz::reads([&] { tribench::measured::parse_manifest(input, "set.toml"); });
}
