// SPDX-License-Identifier: MIT
//
// The documents hold together: links lead somewhere, every page is in the index, and what the
// program writes of itself is what stands there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/paths.hpp"
#include "tests/support/run_program.hpp"

namespace tribench::testing {
namespace {

namespace fs = std::filesystem;

// Every page of the checkout but those that others wrote or a build left.
std::vector<fs::path> all_pages() {
  std::vector<fs::path> pages;
  for (auto entry = fs::recursive_directory_iterator(source_dir());
       entry != fs::recursive_directory_iterator(); ++entry) {
    const std::string name = entry->path().filename().string();
    if (entry->is_directory() && (name.starts_with('.') || name.starts_with("build"))) {
      entry.disable_recursion_pending();
    } else if (entry->path().extension() == ".md") {
      pages.push_back(entry->path());
    }
  }
  return pages;
}

// Without what stands between fences or backquotes: there brackets are code.
std::string prose(const std::string& text) {
  std::string result;
  bool is_fenced = false;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) is_fenced = !is_fenced;
    if (is_fenced || line.starts_with("    ")) continue;
    result += std::regex_replace(line, std::regex("`[^`]*`"), "") + "\n";
  }
  return result;
}

std::vector<std::string> links_of(const std::string& text) {
  static const std::regex kLink(R"(\]\(([^)\s]+)\))");
  std::vector<std::string> links;
  const std::string read = prose(text);
  for (std::sregex_iterator one(read.begin(), read.end(), kLink), end; one != end; ++one) {
    links.push_back((*one)[1]);
  }
  return links;
}

// As the usual renderers make them of headings.
std::set<std::string> anchors_of(const std::string& text) {
  std::set<std::string> anchors;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with('#')) continue;
    std::string anchor;
    for (const char c : line.substr(line.find_first_not_of("# "))) {
      if (c == ' ') anchor += '-';
      const auto byte = static_cast<unsigned char>(c);
      if (std::isalnum(byte) != 0 || c == '-' || c == '_') {
        anchor += static_cast<char>(std::tolower(byte));
      }
    }
    anchors.insert(anchor);
  }
  return anchors;
}

TEST(Documentation, EveryLinkLeadsSomewhere) {
  std::size_t followed = 0;
  for (const fs::path& page : all_pages()) {
    for (const std::string& link : links_of(read_text(page))) {
      if (link.find("://") != std::string::npos || link.starts_with("mailto:")) continue;
      ++followed;
      const std::size_t hash = link.find('#');
      const fs::path target =
          hash == 0 ? page : (page.parent_path() / link.substr(0, hash)).lexically_normal();
      ASSERT_TRUE(fs::exists(target)) << page << " links to " << link;
      if (hash == std::string::npos) continue;
      EXPECT_THAT(anchors_of(read_text(target)), ::testing::Contains(link.substr(hash + 1)))
          << page << " links to " << link;
    }
  }
  EXPECT_GT(followed, 50U);
}

TEST(Documentation, EveryPageIsInTheIndex) {
  const fs::path docs = source_dir() / "docs";
  const std::vector<std::string> links = links_of(read_text(docs / "README.md"));
  for (const auto& entry : fs::directory_iterator(docs)) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() != ".md" || name == "README.md") continue;
    EXPECT_THAT(links, ::testing::Contains(name));
  }
}

TEST(Documentation, TheCommandLineIsWhatTheProgramSays) {
  const ProgramRun run = run_tribench({"describe", "markdown"});
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_EQ(run.output, read_text(source_dir() / "docs/command_line.md"))
      << "write it anew: tribench describe markdown > docs/command_line.md";
}

TEST(Documentation, TheFilesPageHasEveryColumnOfResults) {
  const std::string page = read_text(source_dir() / "docs/files.md");
  const std::string header = read_text(source_dir() / "tests/golden/reports/results.csv");
  std::istringstream names(header.substr(0, header.find('\n')));
  for (std::string name; std::getline(names, name, ',');) {
    EXPECT_THAT(page, ::testing::HasSubstr("`" + name + "`"));
  }
}

}  // namespace
}  // namespace tribench::testing
