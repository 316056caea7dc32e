// SPDX-License-Identifier: MIT
//
// Every fuzz target over its corpus: seeds, and each input that was ever found to break something.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/fuzz/fuzz_target.hpp"
#include "tests/support/paths.hpp"

namespace tribench::fuzz {
namespace {

namespace fs = std::filesystem;

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

INSTANTIATE_TEST_SUITE_P(Targets, Corpus, ::testing::ValuesIn(target_names()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace tribench::fuzz
