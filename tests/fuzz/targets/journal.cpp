// SPDX-License-Identifier: MIT
//
// A run's journal is refused, or read but for its damaged lines. Every second try each line of the
// input is taken as a body and given the checksum that it has, so that what is inside is read too.
#include <sstream>

#include "harness/journal.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace {

using namespace tribench;

void try_journal(std::string_view text) {
  const fuzz::MemoryFile file(text);
  fuzz::reads([&] {
    const JournalContents contents = read_journal(file.path());
    fuzz::expect(contents.good_bytes <= text.size(), "more good bytes than there are");
  });
}

}  // namespace

TRIBENCH_FUZZ_TARGET(journal) {
  try_journal(input);
  std::istringstream bodies{std::string(input)};
  std::string text;
  for (std::string body; std::getline(bodies, body);) text += journal_line(body);
  try_journal(text);
}
