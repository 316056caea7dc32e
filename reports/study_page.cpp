// SPDX-License-Identifier: MIT
#include "reports/study_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "foundation/error.hpp"
#include "foundation/output_file.hpp"
#include "foundation/text.hpp"
#include "reports/figures.hpp"
#include "reports/leaderboard.hpp"
#include "reports/markdown.hpp"
#include "reports/pictures.hpp"
#include "reports/proofs.hpp"
#include "reports/published.hpp"
#include "reports/sensitivity.hpp"

namespace tribench {
namespace {

namespace fs = std::filesystem;

// A command line without the folders of the machine it ran on.
std::string portable(const std::string& command_line) {
  std::istringstream in(command_line);
  std::string text;
  for (std::string word; in >> word;) {
    const std::size_t quote = word.starts_with('\'') ? 1 : 0;
    if (word.substr(quote).starts_with('/')) {
      word = word.substr(0, quote) + fs::path(word).filename().string();
    }
    text += (text.empty() ? "" : " ") + word;
  }
  return text;
}

double number_at(const RunFolder& run, const std::string& key) {
  const std::string text = run.provenance_of(key);
  return text.empty() ? 0 : std::stod(text);
}

std::string how_it_was_made(const RunFolder& run, const RunSummary& summary) {
  MarkdownTable table({{"what"}, {"which"}});
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) table.add({name, value});
  };
  add("command", markdown_code(portable(run.provenance_of("sessions.0.command_line"))));
  add("program", fmt::format("tribench {}, commit {}{}", run.provenance_of("code.version"),
                             run.provenance_of("code.commit"),
                             run.provenance_of("code.dirty") == "true" ? " and changes" : ""));
  add("compiler",
      fmt::format("{} {}", run.provenance_of("code.compiler"), run.provenance_of("code.flags")));
  add("processor", run.provenance_of("sessions.0.machine.cpu"));
  add("workers", run.provenance_of("sessions.0.jobs"));
  double wall_s = 0;
  for (std::size_t i = 0; !run.provenance_of(fmt::format("sessions.{}.started", i)).empty(); ++i) {
    wall_s += number_at(run, fmt::format("sessions.{}.wall_s", i));
  }
  add("wall time", duration_figure(wall_s));
  add("CPU time in fits", duration_figure(summary.fit_cpu_s));
  add("cells",
      fmt::format("{}, {} failed, {} missing", summary.cells, summary.failed, run.missing.size()));
  std::size_t seeds = 0;
  for (const ProblemTable& each : summary.tables) seeds = std::max(seeds, each.seeds);
  add("seeds of a method on a problem", fmt::format("{}", seeds));
  add("fingerprint of the results", run.provenance_of("fingerprint"));
  return "\n## How it was made\n\n" + table.text();
}

std::string settings(const RunFolder& run) {
  const std::string grid = read_file_if_there(run.path / "grid.toml").value_or("");
  return grid.empty() ? grid
                      : fmt::format(
                            "\n## Settings\n\nThe grid as it took effect; a method's parameters "
                            "that are not named have their defaults (`tribench list methods "
                            "--json`).\n\n```toml\n{}\n```\n",
                            grid.substr(0, grid.find_last_not_of('\n') + 1));
}

constexpr std::string_view kPublishedWords =
    "\n## Published figures beside ours\n\n"
    "Mean absolute errors on test movements, medians over the seeds with their range. The *noise "
    "ceiling* is the\n"
    "error of the noise-free target itself; *law refitted* that of the true law with its constants "
    "fitted to the same\n"
    "training rows, stage by stage: the best that can be expected of data like these with the "
    "inputs that each stage\n"
    "is permitted. Both columns *against* are ratios seed by seed, the median with its exact 95 % "
    "interval. Where a\n"
    "published table counts the complexity of an adaptation alone, so does ours.\n";

// The pictures a page shows: of each problem with published figures, in the first operator set.
std::vector<std::string> wanted_pictures(const RunSummary& summary,
                                         const std::vector<PublishedProblem>& published) {
  std::vector<std::string> names;
  if (summary.operators.empty()) return names;
  for (const PublishedProblem& problem : published) {
    for (const char* id : {"profile", "error"}) {
      names.push_back(picture_file(problem.problem, summary.operators.front(), id));
    }
  }
  return names;
}

}  // namespace

std::string study_page(const RunFolder& run, const RunSummary& summary, const StudyPage& extra) {
  std::vector<std::string> complaints = run.complaints;
  const std::vector<PublishedProblem> published =
      match_published(read_published(run.path / kPublishedFile, complaints), summary);
  std::string text = fmt::format(
      "<!-- Written by `tribench report RUN --page FILE`; do not edit. -->\n\n# The run {}\n",
      run.name);
  text += how_it_was_made(run, summary);
  for (const std::string& complaint : complaints) text += fmt::format("\n- {}\n", complaint);
  if (!published.empty()) {
    text += kPublishedWords;
    text += published_markdown(published, "###");
  }
  text += extra.sections;
  for (std::size_t i = 0; i < extra.pictures.size(); ++i) {
    text += fmt::format("{}\n![{}]({})\n", i == 0 ? "\n## Pictures\n" : "",
                        fs::path(extra.pictures[i]).stem().string(), extra.pictures[i]);
  }
  text += proofs_section(run);
  text += sensitivity_section(ranking_sensitivity(run, summary));
  return text + settings(run);
}

void write_study_page(const fs::path& folder, const fs::path& page, const std::string& sections) {
  const RunFolder run = read_run_folder(folder);
  const RunSummary summary = summarise(run);
  std::vector<std::string> complaints;
  const std::vector<PublishedProblem> published =
      match_published(read_published(folder / kPublishedFile, complaints), summary);
  StudyPage extra{sections, {}};
  const fs::path pictures = page.parent_path() / page.stem();
  const std::vector<std::string> wanted = wanted_pictures(summary, published);
  if (!wanted.empty()) {
    for (const std::string& name : write_pictures(folder, pictures, wanted)) {
      extra.pictures.push_back((page.stem() / name).string());
    }
  }
  if (page.has_parent_path()) fs::create_directories(page.parent_path());
  write_file(page, study_page(run, summary, extra));
}

}  // namespace tribench
