// SPDX-License-Identifier: MIT
//
// Rules of style that neither clang-format nor clang-tidy knows.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include "foundation/text.hpp"
#include "tests/support/paths.hpp"

namespace tribench {
namespace {

namespace fs = std::filesystem;
using ::testing::IsEmpty;

// "file: match" for each match in the sources below the folders.
std::vector<std::string> matches(const std::vector<std::string>& folders, const std::regex& what) {
  std::vector<std::string> found;
  for (const std::string& folder : folders) {
    for (const auto& entry : fs::recursive_directory_iterator(testing::source_dir() / folder)) {
      if (entry.path().extension() != ".cpp") continue;
      const std::string text = read_file(entry.path());
      for (std::sregex_iterator at(text.begin(), text.end(), what), end; at != end; ++at) {
        found.push_back(entry.path().filename().string() + ": " + at->str());
      }
    }
  }
  return found;
}

// A test is called by a sentence in CamelCase: TEST(InputBox, RefusesWhatIsNoRange).
TEST(SourceStyle, TestsHaveNamesOfOneStyle) {
  const std::regex any_test(R"(\bTEST(_F|_P)?\(\w+,\s*\w+\))");
  EXPECT_GT(matches({"tests"}, any_test).size(), 1000U) << "the rule sees no tests any more";
  EXPECT_THAT(
      matches({"tests"}, std::regex(R"(\bTEST(_F|_P)?\(\w+,\s*([a-z]\w*|(?!DISABLED_)\w*_\w*)\))")),
      IsEmpty());
}

// An exception must not leave an OpenMP region: parallel_for holds it, and so does the run's loop.
TEST(SourceStyle, ThreadsAreBegunWhereExceptionsAreHeld) {
  EXPECT_THAT(matches({"foundation", "problems", "algorithms", "reports", "harness"},
                      std::regex(R"(#pragma omp parallel)")),
              ::testing::ElementsAre("run.cpp: #pragma omp parallel"));
}

// Whose name another user can foretell, or the same tests of another checkout use as well.
TEST(SourceStyle, TemporaryFoldersAreScratchFolders) {
  EXPECT_THAT(
      matches({"foundation", "problems", "algorithms", "reports", "harness"},
              std::regex(R"(mkdtemp\(|mkstemp\(|tmpnam\(|temp_directory_path\(|"/tmp)")),
      ::testing::UnorderedElementsAre("output_folder.cpp: mkstemp(", "scratch_folder.cpp: \"/tmp",
                                      "scratch_folder.cpp: mkdtemp("));
  std::vector<std::string> in_tests =
      matches({"tests"}, std::regex(R"(mkdtemp\(|mkstemp\(|TempDir\(|temp_directory_path\()"));
  std::erase_if(in_tests, [](const std::string& found) {
    return found.starts_with("source_style_test.cpp: ");  // what is expected here
  });
  EXPECT_THAT(in_tests, ::testing::UnorderedElementsAre("run_program.cpp: mkdtemp(",
                                                        "run_program.cpp: temp_directory_path("));
}

// dump() throws where a text is not UTF-8, as a file's name may be.
TEST(SourceStyle, JsonIsWrittenByWriteJson) {
  EXPECT_THAT(matches({"foundation", "problems", "algorithms", "reports", "harness"},
                      std::regex(R"(\.dump\()")),
              ::testing::ElementsAre("json_text.cpp: .dump("));
}

// fmt::print throws where the stream takes nothing: a full disk behind standard error would end the
// program from within its threads.
TEST(SourceStyle, MessagesGoByPrintMessage) {
  EXPECT_THAT(matches({"foundation", "problems", "algorithms", "reports", "harness"},
                      std::regex(R"(fmt::print\(\s*stderr)")),
              IsEmpty());
}

}  // namespace
}  // namespace tribench
