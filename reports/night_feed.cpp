// SPDX-License-Identifier: MIT
#include "reports/night_feed.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "foundation/random.hpp"
#include "reports/markup.hpp"

namespace tribench {
namespace {

constexpr std::size_t kEntries = 100;

struct FeedEntry {
  std::string name;     // what it is about and since when: the same whenever the feed is written
  std::string updated;  // UTC, as the store has it: RFC 3339
  std::string title;
  std::string content;
};

// A feed needs a time; a night that does not say when it was is as old as time.
std::string time_or_epoch(const std::string& time) {
  return time.empty() ? "1970-01-01T00:00:00Z" : time;
}

FeedEntry entry_of(const HistoryChange& change, const StoreHistory& history) {
  const Night& night = history.nights[change.night];
  const double percent = 100 * (change.ratio - 1);
  const std::string what = change.method.empty() ? change.problem
                                                 : fmt::format("{} ({}) on {}", change.method,
                                                               change.operators, change.problem);
  return {fmt::format("{}|{}|{}", night.name, change.figure, what), time_or_epoch(night.started),
          fmt::format("{}: {:+.1f} % {}", what, percent, change.figure),
          fmt::format("Since night {}, code {} {}, on {}.", night.name, night.code, night.commit,
                      night.machine)};
}

}  // namespace

std::string history_feed(const StoreHistory& history) {
  std::vector<FeedEntry> entries;
  for (const HistoryChange& change : changes_of(history)) {
    entries.push_back(entry_of(change, history));
  }
  for (const Blessing& each : history.blessings) {
    entries.push_back({fmt::format("{}|base", each.when), time_or_epoch(each.when),
                       fmt::format("The base is now {}", each.night), each.reason});
  }
  std::ranges::stable_sort(entries, std::greater<>(), &FeedEntry::updated);
  entries.resize(std::min(entries.size(), kEntries));
  const std::string updated = entries.empty() ? time_or_epoch("") : entries.front().updated;
  std::string feed = fmt::format(
      "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<feed xmlns=\"http://www.w3.org/2005/Atom\">"
      "<title>tribench: nights</title><id>tag:tribench,2026:nights</id><updated>{}</updated>"
      "<author><name>tribench</name></author><link rel=\"alternate\" href=\"nights.html\"/>\n",
      markup_text(updated));
  for (const FeedEntry& each : entries) {
    feed += fmt::format(
        "<entry><id>tag:tribench,2026:{:016x}</id><title>{}</title><updated>{}</updated>"
        "<content type=\"text\">{}</content></entry>\n",
        key_of(each.name), markup_text(each.title), markup_text(each.updated),
        markup_text(each.content));
  }
  return feed + "</feed>\n";
}

}  // namespace tribench
