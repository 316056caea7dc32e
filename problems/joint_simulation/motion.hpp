// SPDX-License-Identifier: MIT
//
// What the simulated joint does: movements that are known as functions of time, so that friction
// can be integrated along them in steps of any length.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "foundation/random.hpp"

namespace tribench::simulation {

// How a campaign is laid out. All take five to ten minutes of motion.
enum class Design {
  mixed,       // 70 movements: strokes there and back at many speeds, sums of three sines
  few_long,    // 8 of a minute each
  many_short,  // 220 of a second or two, one stroke each
  one_way,     // 80 strokes, all forwards; the way back was not recorded
};
std::string_view design_name(Design design);
inline constexpr std::array kDesigns = {Design::mixed, Design::few_long, Design::many_short,
                                        Design::one_way};

struct MotionState {
  double position_rad = 0;
  double velocity_rad_s = 0;
  double acceleration_rad_s2 = 0;
};

// amplitude_rad sin(rate_rad_s t + phase_rad)
struct Sine {
  double amplitude_rad = 0;
  double rate_rad_s = 0;
  double phase_rad = 0;
};

class Movement {
 public:
  // From start_rad, to be continued by strokes.
  explicit Movement(double start_rad) : end_{start_rad, 0, 0} {}
  // A sum of sines about a centre.
  Movement(double centre_rad, std::array<Sine, 3> sines, double duration_s)
      : end_{centre_rad, 0, 0}, sines_(sines), duration_s_(duration_s) {}

  // From standstill to standstill: speeds up, keeps the speed where the way is long enough, slows
  // down. speed and acceleration > 0.
  void add_stroke(double target_rad, double speed_rad_s, double acceleration_rad_s2);

  double duration_s() const { return duration_s_; }
  double end_rad() const { return end_.position_rad; }
  MotionState at(double t_s) const;  // 0 <= t_s <= duration_s()

  Sine other;             // the other joint's motion; at rest where its amplitude is 0
  double gravity_nm = 0;  // gravity torque: gravity_nm sin(q + gravity_phase_rad)
  double gravity_phase_rad = 0;
  double pause_s = 0;  // at rest after it

 private:
  void add_piece(double acceleration, double duration_s);

  struct Piece {  // of constant acceleration
    double begin_s = 0;
    MotionState state;
  };
  std::vector<Piece> pieces_;
  MotionState end_;  // of the strokes; the centre of the sines
  std::array<Sine, 3> sines_{};
  double duration_s_ = 0;
};

MotionState motion_of(const Sine& sine, double t_s);

// In the order in which they are done.
std::vector<Movement> make_movements(Design design, RandomStream random);

}  // namespace tribench::simulation
