// SPDX-License-Identifier: MIT
//
// Is the same said of a recording however it is told? Every recording is told in each of the ways
// of retelling.hpp, and what `tribench loop` answers is compared with its answer to the first
// telling: verdict and families, and the errors of the refitted model.
//
// The loop is asked as a user asks it, by files and options: reading is tried with it.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "harness/study/retelling.hpp"

namespace tribench {

// What was answered, in short.
struct LoopStory {
  std::string verdict;                // of loop.json; "FAILED" where there was no answer
  std::vector<std::string> families;  // sorted
  double mae_before = 0;              // held out; NaN where it could not be judged
  double mae_after = 0;
  std::string complaint;  // of the loop, where it failed

  bool same_as(const LoopStory& other) const {
    return verdict == other.verdict && families == other.families;
  }
  std::string text() const;  // "EFFECTS stribeck + lag, 0.31 -> 0.24"
};

// Called from several threads at once.
using StoryTeller = std::function<LoopStory(const RecordingToTell&)>;

// Asks a program ("/usr/bin/tribench"): `program loop FILES OPTIONS --seed N --json`, with one
// thread. A program that cannot be started throws Error (failed).
StoryTeller make_loop_teller(std::string program);

struct RetellingOutcome {
  std::string recording;
  const Retelling* retelling = nullptr;
  LoopStory first;
  LoopStory again;         // errors in the first telling's unit
  RecordingToTell told;    // only where the story changed
  double error_ratio = 0;  // again / first, after the refit; NaN where one is not known
  bool same = true;        // verdict and families
  bool same_bits = true;   // the errors too
};

struct RetellingFigure {
  std::string retelling;
  std::string summary;
  std::size_t told = 0;
  std::size_t same = 0;
  double share = 0;  // same / told, with its Wilson interval, 95 %
  double low = 0;
  double high = 0;
  double target = 1;     // of the share
  std::size_t bits = 0;  // tellings with the same story and the same errors bit for bit
  double ratio = 0;      // geometric mean of the error ratios, with its bootstrap interval
  double ratio_low = 0;
  double ratio_high = 0;
  double ratio_largest = 1;  // the one farthest from 1
  bool met = true;           // the share, and every error within what the retelling allows
};

struct RetellingStudy {
  std::vector<RetellingOutcome> outcomes;  // by recording, then by retelling
  std::vector<RetellingFigure>
      figures;               // by retelling; those nothing could be told in are left out
  std::size_t left_out = 0;  // recordings, when it was stopped
};

struct RetellingStudyOptions {
  std::vector<std::string> retellings;  // names; empty: all
  int threads = 0;                      // 0: all; the figures are the same for any number
  bool quiet = true;                    // no progress line
  // Recordings that are not told all their ways when it is set are left out.
  const std::atomic<bool>* stop = nullptr;
};

// Throws Error (bad_input) where a first telling fails. Cost: a run of the loop each.
RetellingStudy run_retelling_study(const std::vector<RecordingToTell>& recordings,
                                   const StoryTeller& teller, const RetellingStudyOptions& options);

}  // namespace tribench
