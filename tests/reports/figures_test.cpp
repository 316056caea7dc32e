// SPDX-License-Identifier: MIT
#include "reports/figures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "reports/markdown.hpp"

namespace tribench {
namespace {

TEST(Figure, KeepsThreeSignificantDigitsWithoutExponentWhereItCan) {
  EXPECT_EQ(figure(0.037149), "0.0371");
  EXPECT_EQ(figure(12.345), "12.3");
  EXPECT_EQ(figure(9.9961), "10.0");
  EXPECT_EQ(figure(1234.5), "1234");
  EXPECT_EQ(figure(-0.5), "-0.500");
  EXPECT_EQ(figure(1.234e-7), "1.23e-07");
  EXPECT_EQ(figure(0), "0");
  EXPECT_EQ(figure(std::nan("")), "-");
  EXPECT_EQ(figure(std::numeric_limits<double>::infinity()), "inf");
}

TEST(Duration, PicksTheUnitPeopleSay) {
  EXPECT_EQ(duration_figure(0.0214), "0.0214 s");
  EXPECT_EQ(duration_figure(600), "10.0 min");
  EXPECT_EQ(duration_figure(36000), "10.0 h");
}

TEST(MarkdownTable, PadsByCodePointsAndEscapesBars) {
  MarkdownTable table({{"name"}, {"x", Align::right}});
  table.add({"a|b", "1"});
  table.add({"\xC2\xB5m", "22"});
  EXPECT_EQ(table.text(),
            "| name |   x |\n"
            "| ---- | --: |\n"
            "| a\\|b |   1 |\n"
            "| \xC2\xB5m   |  22 |\n");
}

TEST(MarkdownTable, LetsNoTagAndNoControlCharacterThrough) {
  MarkdownTable table({{"name"}});
  table.add({"<img src=x onerror=alert(1)>\x1b[31m\n"});
  EXPECT_NE(table.text().find("\n| &lt;img src=x onerror=alert(1)> [31m  |\n"), std::string::npos)
      << table.text();
}

// Of a page what is no tag stays as it reads best.
TEST(Markdown, APageHasNoTagOfAnybodysName) {
  EXPECT_EQ(without_tags("# <b>x|y\x07, p < 0.05, a <= b\n`</script>` <!-- -->\n"),
            "# &lt;b>x|y?, p < 0.05, a <= b\n`</script>` &lt;!-- -->\n");
}

// In code a renderer shows `&lt;` as it stands, and `<b>` too; but code must it be whichever way
// the backticks are paired: in a cell, in the line, or in the paragraph.
TEST(Markdown, CodeShowsWhatIsLessAndStrayBackticksLetNoTagThrough) {
  const auto row = [](const std::string& cell) {
    MarkdownTable table({{"name"}});
    table.add({cell});
    const std::string text = table.text();
    return text.substr(text.rfind("\n| ") + 3, text.rfind(" |") - text.rfind("\n| ") - 3);
  };
  EXPECT_EQ(row("`v<w` and `` a`<b> ``"), "`v<w` and `` a`<b> ``");
  EXPECT_EQ(row("`a|<b>` <i>"), "`a\\|<b>` &lt;i>");
  EXPECT_EQ(row("`<b>"), "`&lt;b>");
  EXPECT_EQ(row("a` `<b>`"), "a` `&lt;b>`");
  EXPECT_EQ(row("``<b>`"), "``&lt;b>`");
  EXPECT_EQ(row("\\`<b>`"), "\\`&lt;b>`");
  EXPECT_EQ(row("`a\\|<b>`"), "`a\\\\|&lt;b>`");
  EXPECT_EQ(without_tags("| `v<w` | `<b>` |\n"), "| `v<w` | `<b>` |\n");
  EXPECT_EQ(without_tags("| a` | b` `<b>` |\n"), "| a` | b` `&lt;b>` |\n");
  EXPECT_EQ(without_tags("a`\n`<b>`\n\n`<b>`\n"), "a`\n`&lt;b>`\n\n`<b>`\n");
}

TEST(Markdown, CodeMayHoldAnyBackticks) {
  EXPECT_EQ(markdown_code("a*b"), "`a*b`");
  EXPECT_EQ(markdown_code("a`b"), "``a`b``");
  EXPECT_EQ(markdown_code("a``b`c"), "```a``b`c```");
  EXPECT_EQ(markdown_code("a`"), "`` a` ``");
}

TEST(Shortened, NeverCutsACodePoint) {
  EXPECT_EQ(shortened("abcdef", 6), "abcdef");
  EXPECT_EQ(shortened("abcdefg", 6), "abc...");
  EXPECT_EQ(shortened("\xC2\xB5\xC2\xB5\xC2\xB5\xC2\xB5\xC2\xB5", 4), "\xC2\xB5...");
}

}  // namespace
}  // namespace tribench
