// SPDX-License-Identifier: MIT
//
// What an exploration has asked and was answered, as it happens: a line of journal.jsonl each, the
// recording in it. Seconds of motion are paid for once: begun again in the same folder with the
// same settings, an exploration has its first answers from there, asks the same (the explorer is
// deterministic), and goes on where it was. Not for answers that differ when they are asked again
// from the start.
#pragma once

#include <deque>
#include <filesystem>
#include <string>

#include "algorithms/exploration/explorer.hpp"

namespace tribench {

// What has to be the same, or the answers would not be asked for again; where the joint stood and
// the seconds of motion it had left are those of the first time.
struct ExplorationSetting {
  std::string asked;   // the world or the program, the plan and the options, as text
  std::string limits;  // as JSON; of a world the seconds left are not among them
  double start_rad = 0;
  double seconds_left = 0;
};

class ExplorationFolder {
 public:
  // Makes the folder, or reads what stands there; `setting` becomes that of the first time. A last
  // line that was cut off is left out. Throws Error (bad_input) where another exploration was
  // begun.
  ExplorationFolder(std::filesystem::path folder, ExplorationSetting& setting);

  std::size_t answers() const { return known_.size(); }
  // The known answers, one after the other, then those of `execute`, each written down at once.
  // Throws what `execute` throws, and Error (failed) where another movement than the first time is
  // asked for. The folder must live as long.
  loop::ExecuteMovement remembering(loop::ExecuteMovement execute);

 private:
  struct Answer {
    std::string movement;  // a line of a movements file
    std::string refused;   // why; empty: it was not
    std::string recording;
  };
  Dataset known_answer(const std::string& movement);
  void write_down(const Answer& answer) const;

  std::filesystem::path journal_;
  std::deque<Answer> known_;
};

}  // namespace tribench
