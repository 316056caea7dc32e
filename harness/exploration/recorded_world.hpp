// SPDX-License-Identifier: MIT
//
// Measured recordings in the place of a simulated joint: who asks for a movement is given, of the
// recorded movements that nobody has had yet, the one that is nearest to it, and is told which. Its
// torque was not looked at before. Nothing is sealed: nobody knows what a real joint hides.
//
//   world.json      limits that the recordings keep to, their number and SHA-256
//   recordings.csv  the movements, long ones cut up
//   executed.csv    what has been asked for so far; who was given what follows from it
//
// Nearest: by the means of the velocity and of its size, in the largest speed, and by the mean, the
// least and the greatest position, in the range of positions.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "harness/exploration/world_folder.hpp"
#include "problems/dataset.hpp"
#include "problems/experiment/motion_limits.hpp"
#include "problems/experiment/planned_movement.hpp"

namespace tribench {

class RecordedWorld {
 public:
  // data: prepared (recording.hpp), in rad. Movements of more than longest_s are cut up. Throws
  // Error (bad_input) where the folder holds a world already, or where there is no time, position,
  // velocity or torque.
  static RecordedWorld create(const std::filesystem::path& folder, const Dataset& data,
                              double longest_s, double gear_ratio);
  static bool is_in(const std::filesystem::path& folder);
  // Repeats what was asked for. Throws Error (bad_input) where recordings.csv was changed.
  explicit RecordedWorld(const std::filesystem::path& folder);

  const MotionLimits& limits() const { return limits_; }
  double seconds_used() const { return used_s_; }
  double position_rad() const { return position_rad_; }
  std::size_t movements() const { return recorded_.size(); }

  struct Answer {
    Dataset rows;
    std::vector<std::string> given;  // what was recorded, a name a movement
  };
  // All of them or none: Throws Error (bad_input) where fewer are left than are asked for.
  Answer execute(const std::vector<PlannedMovement>& wanted, const std::string& file,
                 const KeepRows& keep = {});

 private:
  struct Recorded {
    std::string name;
    Dataset rows;
    double seconds = 0;
    std::vector<double> features;
    bool given = false;
  };

  void take_over(const Dataset& recordings);
  Recorded& nearest(const PlannedMovement& wanted);
  void give(const PlannedMovement& wanted, Answer& answer);

  std::filesystem::path folder_;
  MotionLimits limits_;
  std::vector<Recorded> recorded_;
  std::vector<PlannedMovement> asked_;
  double used_s_ = 0;
  double position_rad_ = 0;
};

}  // namespace tribench
