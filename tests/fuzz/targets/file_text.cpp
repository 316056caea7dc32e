// SPDX-License-Identifier: MIT
//
// A file of any bytes, packed or not, either is refused or becomes a text in UTF-8.
#include "problems/reading/file_text.hpp"

#include "foundation/text.hpp"
#include "tests/fuzz/fuzz_target.hpp"

TRIBENCH_FUZZ_TARGET(file_text) {
  using namespace tribench;
  constexpr std::size_t kMostUnpacked = std::size_t{1} << 22;
  const fuzz::MemoryFile file(input);
  std::string text;
  if (!fuzz::reads([&] { text = read_file_text(file.path(), kMostUnpacked); })) return;
  fuzz::expect(is_utf8(text), "the text is no UTF-8");
}
