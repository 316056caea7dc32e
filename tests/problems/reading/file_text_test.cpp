// SPDX-License-Identifier: MIT
#include "problems/reading/file_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <fstream>
#include <string>

#include "foundation/error.hpp"
#include "foundation/scratch_folder.hpp"

namespace tribench {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class PackedText : public ::testing::Test {
 protected:
  std::filesystem::path pack(const std::string& text, int times = 1) const {
    const std::filesystem::path file = folder_.path() / "log.csv.gz";
    const gzFile out = gzopen(file.c_str(), "wb");
    for (int i = 0; i < times; ++i) {
      gzwrite(out, text.data(), static_cast<unsigned>(text.size()));
    }
    gzclose(out);
    return file;
  }

 private:
  ScratchFolder folder_;
};

TEST_F(PackedText, ThatOpensToAThousandTimesItsSizeIsRefused) {
  constexpr std::size_t kMost = 100000;
  const std::filesystem::path file = pack(std::string(kMost + 1, '1'));
  const auto size = std::filesystem::file_size(file);
  ASSERT_LT(100 * size, kMost);
  try {
    read_file_text(file, kMost);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    EXPECT_EQ(error.place(), file.string());
    EXPECT_THAT(error.what(), AllOf(HasSubstr(std::to_string(size) + " bytes"),
                                    HasSubstr("more than 100000"), HasSubstr("gunzip")));
  }
  EXPECT_EQ(read_file_text(pack(std::string(kMost, '1')), kMost), std::string(kMost, '1'));
}

// The most memory that the process has had since the peak was last forgotten, in MiB.
double peak_mib() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) / 1024;
  }
  return 0;
}

// It took twice what was allowed before it was refused.
TEST_F(PackedText, ThatIsRefusedTakesNoMemory) {
  constexpr std::size_t kMiB = std::size_t{1} << 20;
  const std::filesystem::path file = pack(std::string(kMiB, '1'), 200);
  std::ofstream("/proc/self/clear_refs") << "5";
  const double before = peak_mib();
  EXPECT_THROW(read_file_text(file, 199 * kMiB), Error);
  EXPECT_LT(peak_mib() - before, 20);
  EXPECT_EQ(read_file_text(file, 200 * kMiB).size(), 200 * kMiB);
}

TEST_F(PackedText, OfARecordingMayBeAsLongAsItIs) {
  std::string text;
  for (int i = 0; i < 20000; ++i) text += std::to_string(i * i % 1009) + ",0.25\n";
  EXPECT_EQ(read_file_text(pack(text), 1000), text);
}

}  // namespace
}  // namespace tribench
