// SPDX-License-Identifier: MIT
//
// Data travels one way between the rooms; an #include that runs back fails here.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/support/paths.hpp"

namespace tribench::testing {
namespace {

using Rooms = std::set<std::string>;

// What a room may include besides itself. A method's room is "method:<folder>".
const std::map<std::string, Rooms>& allowed() {
  static const Rooms kBelowTheHarness = {
      "foundation",       "problems",    "expression", "interface",   "fitting",  "inference",
      "states",           "effects",     "method",     "diagnosis",   "registry", "reports",
      "forward_dynamics", "exploration", "loop_model", "closed_loop", "campaign", "leftover"};
  const auto with = [](Rooms rooms, const Rooms& more) {
    rooms.insert(more.begin(), more.end());
    return rooms;
  };
  static const std::map<std::string, Rooms> kAllowed = {
      {"foundation", {}},
      {"problems", {"foundation"}},
      {"expression", {"foundation"}},
      {"fitting", {"foundation", "expression"}},
      {"states", {"foundation", "expression", "fitting"}},
      {"interface", {"foundation", "problems", "expression", "states"}},
      {"inference", {"foundation", "expression", "fitting"}},
      {"effects", {"foundation", "problems", "expression"}},
      {"forward_dynamics", {"foundation", "problems", "expression", "fitting", "states"}},
      {"method", {"foundation", "problems", "expression", "interface", "fitting", "states"}},
      {"loop_model",
       {"foundation", "problems", "expression", "interface", "fitting", "inference", "effects",
        "states"}},
      {"campaign",
       {"foundation", "problems", "expression", "fitting", "inference", "effects", "loop_model"}},
      {"leftover",
       {"foundation", "problems", "expression", "fitting", "inference", "effects", "loop_model",
        "campaign"}},
      {"diagnosis",
       {"foundation", "problems", "expression", "fitting", "inference", "effects", "loop_model",
        "campaign", "leftover"}},
      {"closed_loop",
       {"foundation", "problems", "expression", "interface", "inference", "effects", "loop_model",
        "campaign", "diagnosis"}},
      {"exploration",  // above the diagnosis, which it asks
       {"foundation", "problems", "expression", "interface", "fitting", "inference", "effects",
        "loop_model", "campaign", "diagnosis"}},
      {"registry",
       {"foundation", "problems", "expression", "interface", "fitting", "states", "method",
        "closed_loop"}},
      {"reports", {"foundation"}},
      {"harness", kBelowTheHarness},
      {"study", with(kBelowTheHarness, {"harness"})},
      {"cli", with(kBelowTheHarness, {"harness", "study"})},
  };
  return kAllowed;
}

// The room of a file, by its path from the root; empty for what is no room (tests, bench).
std::string room_of(const std::string& path) {
  const std::string top = path.substr(0, path.find('/'));
  if (path.starts_with("harness/study/")) return "study";
  if (path.starts_with("harness/cli/")) return "cli";
  if (top != "algorithms") return allowed().contains(top) ? top : std::string();
  const std::string rest = path.substr(top.size() + 1);
  const std::size_t slash = rest.find('/');
  if (slash == std::string::npos) return rest.starts_with("registry") ? "registry" : "interface";
  const std::string folder = rest.substr(0, slash);
  for (const char* floor :
       {"expression", "fitting", "inference", "states", "effects", "forward_dynamics", "loop_model",
        "campaign", "leftover", "diagnosis", "closed_loop", "exploration"}) {
    if (folder == floor) return folder;
  }
  return "method:" + folder;
}

std::string kind_of(const std::string& room) { return room.substr(0, room.find(':')); }

// Why `from` may not include `to`; empty where it may.
std::string objection(const std::string& from, const std::string& to) {
  const std::string from_room = room_of(from);
  const std::string to_room = room_of(to);
  if (from_room.empty() || to_room.empty() || from_room == to_room) return {};
  if (allowed().at(kind_of(from_room)).contains(kind_of(to_room))) return {};
  return from + " includes " + to + ": " + from_room + " must not know " + to_room;
}

std::vector<std::string> included_files(const std::filesystem::path& file) {
  static const std::regex kInclude(R"re(^\s*#\s*include\s*"([^"]+)")re");
  std::vector<std::string> files;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    std::smatch match;
    if (std::regex_search(line, match, kInclude)) files.push_back(match[1]);
  }
  return files;
}

TEST(IncludeDirection, NoIncludeRunsBack) {
  const std::filesystem::path root = source_dir();
  std::size_t files = 0;
  for (const char* top : {"foundation", "problems", "algorithms", "reports", "harness"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / top)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".hpp" && extension != ".cpp") continue;
      ++files;
      const std::string from = std::filesystem::relative(entry.path(), root).generic_string();
      for (const std::string& to : included_files(entry.path())) {
        EXPECT_EQ(objection(from, to), "");
        EXPECT_TRUE(std::filesystem::exists(root / to))
            << from << " includes " << to << ", which is not a path from the root";
      }
    }
  }
  EXPECT_GT(files, 100U) << "the rooms were not found";
}

TEST(IncludeDirection, TheRuleItselfCatchesAnArrowThatRunsBack) {
  EXPECT_NE(objection("foundation/error.cpp", "problems/problem.hpp"), "");
  EXPECT_NE(objection("problems/table.hpp", "algorithms/regressor.hpp"), "");
  EXPECT_NE(objection("algorithms/expression/print.cpp", "algorithms/regressor.hpp"), "");
  EXPECT_NE(objection("algorithms/pysr/pysr.cpp", "algorithms/model_based/placebos.hpp"), "");
  EXPECT_NE(objection("algorithms/regressor.hpp", "algorithms/registry.hpp"), "");
  EXPECT_NE(objection("algorithms/inference/flips.cpp", "problems/dataset.hpp"), "");
  EXPECT_NE(objection("algorithms/effects/effect_file.cpp", "algorithms/inference/flips.hpp"), "");
  EXPECT_NE(objection("algorithms/regressor.hpp", "algorithms/fitting/evidence.hpp"), "");
  EXPECT_NE(objection("algorithms/fitting/evidence.hpp", "algorithms/regressor.hpp"), "");
  EXPECT_NE(objection("algorithms/closed_loop/closed_loop.cpp", "algorithms/registry.hpp"), "");
  EXPECT_NE(objection("algorithms/closed_loop/closed_loop.cpp", "algorithms/pysr/pysr.hpp"), "");
  EXPECT_NE(objection("algorithms/diagnosis/search.cpp", "algorithms/closed_loop/closed_loop.hpp"),
            "");
  EXPECT_NE(objection("algorithms/campaign/worth.cpp", "algorithms/leftover/leftover.hpp"), "");
  EXPECT_NE(objection("algorithms/leftover/leftover.cpp", "algorithms/diagnosis/diagnosis.hpp"),
            "");
  EXPECT_NE(objection("algorithms/pysr/pysr.cpp", "algorithms/diagnosis/diagnosis.hpp"), "");
  EXPECT_NE(objection("algorithms/pysr/pysr.cpp", "algorithms/effects/effect_file.hpp"), "");
  EXPECT_NE(objection("harness/judge.cpp", "harness/study/loop_study.hpp"), "");
  EXPECT_NE(objection("harness/study/loop_study.cpp", "harness/cli/commands.hpp"), "");
  EXPECT_NE(objection("reports/csv.cpp", "problems/problem.hpp"), "");
  EXPECT_NE(objection("algorithms/pysr/pysr.cpp", "harness/judge.hpp"), "");
  EXPECT_EQ(objection("harness/judge.cpp", "reports/record/record.hpp"), "");
  EXPECT_EQ(objection("algorithms/pysr/pysr.cpp", "algorithms/fitting/constant_fit.hpp"), "");
  EXPECT_EQ(objection("algorithms/registry.cpp", "algorithms/pysr/pysr.hpp"), "");
}

}  // namespace
}  // namespace tribench::testing
