// SPDX-License-Identifier: MIT
//
// Every fuzz target over its corpus: seeds, and each input that was ever found to break something.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "foundation/random.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "tests/support/paths.hpp"

namespace tribench::fuzz {
namespace {

namespace fs = std::filesystem;
using std::string_view_literals::operator""sv;

std::string contents_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<fs::path> corpus_of(const std::string& target) {
  std::vector<fs::path> files;
  const fs::path folder = testing::source_dir() / "tests" / "fuzz" / "corpus" / target;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    files.push_back(entry.path());
  }
  return files;
}

std::vector<std::string> target_names() {
  std::vector<std::string> names;
  for (const auto& [name, target] : targets()) names.push_back(name);
  return names;
}

class Corpus : public ::testing::TestWithParam<std::string> {};

TEST_P(Corpus, HoldsNothingThatBreaksTheTarget) {
  const std::vector<fs::path> files = corpus_of(GetParam());
  EXPECT_GE(files.size(), 2U) << "the corpus of " << GetParam() << " is missing";
  for (const fs::path& file : files) {
    EXPECT_NO_THROW(targets().at(GetParam())(contents_of(file))) << file;
  }
}

// A cut or an empty input is the likeliest of all, and no target's corpus need hold one.
TEST_P(Corpus, CutShortBreaksNothingEither) {
  for (const fs::path& file : corpus_of(GetParam())) {
    const std::string text = contents_of(file);
    for (const std::size_t part : {0, 1, 2, 3}) {
      EXPECT_NO_THROW(targets().at(GetParam())(text.substr(0, text.size() * part / 4))) << file;
    }
  }
}

// An input of the corpus with a few of its bytes changed, left out or taken from another one.
std::string mutated(const std::vector<std::string>& corpus, RandomStream& random) {
  constexpr std::string_view kBytes = "\0\xff\x80\n\"\\{}[],:;-+.e09 "sv;
  std::string text = corpus[random.below(corpus.size())];
  for (std::uint64_t changes = 1 + random.below(6); changes > 0; --changes) {
    const std::size_t at = random.below(text.size() + 1);
    const std::size_t length = std::min<std::size_t>(1 + random.below(24), text.size() - at);
    switch (random.below(4)) {
      case 0:
        text.insert(at, 1, kBytes[random.below(kBytes.size())]);
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1 << random.below(8)));
        break;
      default: {
        const std::string& other = corpus[random.below(corpus.size())];
        const std::size_t from = random.below(other.size() + 1);
        text.insert(at, other.substr(from, 1 + random.below(40)));
      }
    }
  }
  return text;
}

// Blindly, the same ones every time: a fuzzer that sees what it reaches runs at night (fuzz.sh).
TEST_P(Corpus, ChangedBlindlyBreaksNothing) {
  constexpr int kMutations = 4000;
  std::vector<std::string> corpus;
  for (const fs::path& file : corpus_of(GetParam())) corpus.push_back(contents_of(file));
  std::ranges::sort(corpus);  // a folder lists its files in any order
  RandomStream random(key_of("mutations of " + GetParam()));
  ::testing::internal::CaptureStderr();  // libraries complain there
  for (int k = 0; k < kMutations; ++k) {
    const std::string text = mutated(corpus, random);
    EXPECT_NO_THROW(targets().at(GetParam())(text)) << k << ": " << text;
  }
  ::testing::internal::GetCapturedStderr();
}

INSTANTIATE_TEST_SUITE_P(Targets, Corpus, ::testing::ValuesIn(target_names()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace tribench::fuzz
