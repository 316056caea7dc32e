// SPDX-License-Identifier: MIT
#include "harness/journal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>

#include "foundation/error.hpp"
#include "tests/support/run_program.hpp"

namespace tribench {
namespace {

using ::testing::HasSubstr;
using testing::read_text;
using testing::TemporaryFolder;
using testing::write_text;

const RunIdentity kIdentity{"[grid]\nname = 'x'\n", "0.1.0 (abc)", "0123"};

CellResult result(int seed) {
  CellResult r;
  r.record = empty_record({"A/j2/no_load", "m", "paper", static_cast<std::uint64_t>(seed)});
  r.record.status = CellStatus::ok;
  r.record.mae_test = 0.1 + seed;
  r.record.formula = "a \"quoted\" \\ formula\n";
  r.front.push_back({r.record.cell, 3, 4, 0.1, 1.0 / 3.0, Singularity::undecided, true, "v + 1"});
  r.trace.push_back({r.record.cell, 100, 0.5, 1e-300});
  return r;
}

class JournalTest : public ::testing::Test {
 protected:
  std::string written(int count) {
    Journal journal = Journal::create(file_, kIdentity);
    for (int i = 0; i < count; ++i) journal.append(result(i));
    return read_text(file_);
  }
  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "cells.jsonl";
};

TEST_F(JournalTest, ReadsBackWhatWasWrittenBitForBit) {
  written(3);
  const JournalContents contents = read_journal(file_);
  EXPECT_EQ(contents.identity.difference(kIdentity), "");
  EXPECT_TRUE(contents.damage.empty());
  ASSERT_EQ(contents.results.size(), 3U);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(print_result(contents.results[static_cast<std::size_t>(i)]), print_result(result(i)));
  }
}

TEST_F(JournalTest, TornAtAnyByteItLosesTheLastLineAlone) {
  const std::string whole = written(2);
  const std::size_t start_of_last = whole.rfind('\n', whole.size() - 2) + 1;
  for (std::size_t cut = start_of_last; cut < whole.size(); ++cut) {
    write_text(file_, whole.substr(0, cut));
    const JournalContents contents = read_journal(file_);
    ASSERT_EQ(contents.results.size(), 1U) << "cut at byte " << cut;
    ASSERT_EQ(contents.good_bytes, start_of_last);
    if (cut % 50 != 0) continue;  // each of these waits for the disk
    Journal::resume(file_, contents).append(result(1));
    ASSERT_EQ(read_text(file_), whole) << "cut at byte " << cut;
  }
}

TEST_F(JournalTest, ADamagedLineInTheMiddleIsLeftOutAndReported) {
  std::string text = written(3);
  const std::size_t place = text.find("1.1", text.find("\"mae_test\""));
  ASSERT_NE(place, std::string::npos);
  text[place] = '9';
  write_text(file_, text);
  const JournalContents contents = read_journal(file_);
  EXPECT_EQ(contents.results.size(), 2U);
  ASSERT_EQ(contents.damage.size(), 1U);
  EXPECT_THAT(contents.damage[0], HasSubstr("line 3"));
}

TEST_F(JournalTest, RefusesASecondWriterAndAFileThatIsThere) {
  Journal journal = Journal::create(file_, kIdentity);
  EXPECT_THROW(Journal::create(file_, kIdentity), Error);
  EXPECT_THROW(Journal::resume(file_, read_journal(file_)), Error);
}

TEST_F(JournalTest, RefusesToGoOnWithoutWhatAnotherRunWroteMeanwhile) {
  written(1);
  const JournalContents contents = read_journal(file_);
  Journal::resume(file_, contents).append(result(1));
  const std::string both = read_text(file_);
  EXPECT_THROW(Journal::resume(file_, contents), Error);
  EXPECT_EQ(read_text(file_), both);
}

// `ulimit -f 0`, a full disk: the next run finds the folder as it was.
TEST_F(JournalTest, LeavesNoFileThatItCannotBegin) {
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit none{0, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &none), 0);
  EXPECT_THROW(Journal::create(file_, kIdentity), Error);
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_FALSE(std::filesystem::exists(file_));
  EXPECT_NO_THROW(Journal::create(file_, kIdentity));
}

TEST_F(JournalTest, SaysAtTheNextCellThatItsFileWasRemoved) {
  Journal journal = Journal::create(file_, kIdentity);
  journal.append(result(0));
  std::filesystem::remove(file_);
  EXPECT_THROW(journal.append(result(1)), Error);
}

TEST_F(JournalTest, KeepsWhatTheProgramsWere) {
  RunIdentity identity = kIdentity;
  identity.programs = {{"theirs: bash", "0123"}, {"theirs: theirs.sh", "4567"}};
  Journal::create(file_, identity);
  EXPECT_EQ(read_journal(file_).identity.programs, identity.programs);
}

TEST_F(JournalTest, RefusesAFileThatIsNoJournal) {
  write_text(file_, "{\"cells\": 3}\n");
  EXPECT_THROW(read_journal(file_), Error);
  write_text(file_, "");
  EXPECT_THROW(read_journal(file_), Error);
  EXPECT_THROW(read_journal(folder_ / "nowhere"), Error);
}

TEST(RunIdentity, ShowsWhatDiffers) {
  RunIdentity other = kIdentity;
  other.grid = "[grid]\nname = 'y'\n";
  other.code = "0.1.0 (def)";
  const std::string difference = kIdentity.difference(other);
  EXPECT_THAT(difference, HasSubstr("- name = 'x'"));
  EXPECT_THAT(difference, HasSubstr("+ name = 'y'"));
  EXPECT_THAT(difference, HasSubstr("0.1.0 (abc) -> 0.1.0 (def)"));
  RunIdentity with_program = kIdentity;
  with_program.programs = {{"theirs: theirs.py", "01234567"}};
  EXPECT_THAT(kIdentity.difference(with_program),
              HasSubstr("the program's file differs, theirs: theirs.py: none -> 01234567"));
  EXPECT_EQ(with_program.difference(with_program), "");
}

}  // namespace
}  // namespace tribench
