// SPDX-License-Identifier: MIT
//
// What a room calls must be in itself or in a room that it links, its own or theirs: archives that
// are linked together hide a call that runs back, and a link that is missing.
#include <gtest/gtest.h>

#include <iomanip>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "foundation/child_process.hpp"
#include "foundation/text.hpp"

namespace tribench {
namespace {

using Names = std::set<std::string>;

struct RoomArchive {
  Names links;    // rooms, as the build file says
  Names defines;  // symbols that no other archive may define too
  Names calls;    // symbols that are not its own
};
using RoomArchives = std::map<std::string, RoomArchive>;

// nm's lines: "SYMBOL TYPE ...". Weak definitions (inline functions, templates) stand in every
// archive that uses them: they are calls of nobody else's code.
void read_symbols(const std::string& file, RoomArchive& room) {
  const ChildRun run = run_child({.command = {TRIBENCH_NM, "-P", "-g", file}});
  ASSERT_EQ(run.exit.status, 0) << file << ": " << run.errors;
  std::istringstream lines(run.output);
  Names weak;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string symbol;
    std::string type;
    words >> symbol >> type;
    if (type == "U") room.calls.insert(symbol);
    if (type == "T" || type == "D" || type == "B" || type == "R") room.defines.insert(symbol);
    if (type == "W" || type == "V" || type == "u") weak.insert(symbol);
  }
  for (const std::string& own : room.defines) room.calls.erase(own);
  for (const std::string& own : weak) room.calls.erase(own);
}

RoomArchives read_rooms() {
  RoomArchives rooms;
  std::istringstream lines(read_file(TRIBENCH_ROOMS_FILE));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string name;
    std::string archive;
    words >> name >> std::quoted(archive);
    RoomArchive& room = rooms[name];
    for (std::string link; words >> link;) {
      const std::string prefix = "tribench::";
      if (link.starts_with(prefix)) room.links.insert("tribench_" + link.substr(prefix.size()));
    }
    read_symbols(archive, room);
  }
  return rooms;
}

void add_below(const RoomArchives& rooms, const std::string& name, Names& below) {
  const auto found = rooms.find(name);
  if (found == rooms.end()) return;
  for (const std::string& link : found->second.links) {
    if (below.insert(link).second) add_below(rooms, link, below);
  }
}

// "a calls f of b, which it does not link", one a pair of rooms.
std::vector<std::string> objections(const RoomArchives& rooms) {
  std::map<std::string, std::string> home;
  for (const auto& [name, room] : rooms) {
    for (const std::string& symbol : room.defines) home.emplace(symbol, name);
  }
  std::map<std::pair<std::string, std::string>, std::string> found;
  for (const auto& [name, room] : rooms) {
    Names below;
    add_below(rooms, name, below);
    if (below.contains(name)) found[{name, name}] = "itself";
    for (const std::string& symbol : room.calls) {
      const auto at = home.find(symbol);
      if (at == home.end() || at->second == name || below.contains(at->second)) continue;
      found.emplace(std::pair(name, at->second), symbol);
    }
  }
  std::vector<std::string> all;
  for (const auto& [pair, symbol] : found) {
    all.push_back(pair.first + " calls " + symbol + " of " + pair.second +
                  ", which it does not link");
  }
  return all;
}

TEST(LinkDirection, NoRoomCallsWhatItDoesNotLink) {
  const RoomArchives rooms = read_rooms();
  EXPECT_GT(rooms.size(), 15U) << "the rooms were not found";
  for (const std::string& objection : objections(rooms)) ADD_FAILURE() << objection;
}

TEST(LinkDirection, TheRuleItselfCatchesACallThatRunsBackAndACircle) {
  RoomArchives rooms = {{"low", {{}, {"f"}, {"g"}}}, {"high", {{"low"}, {"g"}, {"f"}}}};
  EXPECT_EQ(objections(rooms).size(), 1U);
  rooms["low"].links = {"high"};
  EXPECT_EQ(objections(rooms).size(), 2U);
  rooms["low"] = {{}, {"f"}, {"outside"}};
  EXPECT_TRUE(objections(rooms).empty());
}

}  // namespace
}  // namespace tribench
