// SPDX-License-Identifier: MIT
//
// The motion of one joint over a stretch of time in which what drives it is smooth, with friction
// that is a set at a standstill: the joint sticks as long as what drives it lies between the
// friction of starting either way, and slides else.
//
// How: three modes (sliding forwards, backwards, sticking). Within a mode the equation is smooth
// and is integrated by a pair of orders 3 and 2 with a controlled error (Bogacki, Shampine 1989). A
// velocity of 0 ends a sliding mode; that instant is found by shortening the step. What drives the
// joint then decides the next mode (Karnopp 1985; Filippov's sliding solution). Sticking is left at
// the instant of break-away, found by bisection.
//
// Inputs with a memory are advanced beside it, straight along each stage: second order.
//
// NaN policy: a formula that is not finite ends the run with a status.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string_view>

#include "algorithms/forward_dynamics/joint_model.hpp"

namespace tribench::forward {

struct Tolerances {
  double position = 1e-8;  // of one step, in the position's unit
  double velocity = 1e-7;
  double longest_step_s = std::numeric_limits<double>::infinity();
};

enum class MotionStatus {
  complete,
  not_finite,  // the formula has no finite value, or the equation no solution
  left_range,  // further than any sensible motion goes
  too_many_steps,
};
std::string_view motion_status_name(MotionStatus status);

struct JointState {
  double position = 0;
  double velocity = 0;
  int direction = 0;  // of sliding; 0: it sticks
};

struct IntegrationCounts {
  std::uint64_t steps = 0;  // taken
  std::uint64_t rejected = 0;
  std::uint64_t standstills = 0;  // times the velocity came to 0
  // Standstills at which friction would push the joint off either way: the formula is no friction
  // there. It goes on the way it went.
  std::uint64_t pushed = 0;
};

class JointIntegrator {
 public:
  // The drive, recorded columns and connection at a time within a stretch, written into `at`.
  using Surroundings = std::function<void(double since_begin_s, JointInstant& at)>;

  // The equation must outlive this.
  JointIntegrator(JointEquation& equation, const Tolerances& tolerances)
      : equation_(equation), tolerances_(tolerances) {}

  // Sets the joint there at `time`. A velocity within the tolerance of 0 is 0.
  void begin(double time, double position, double velocity, const Surroundings& around);
  // On by duration_s > 0; positions beyond +-reach end it.
  MotionStatus advance(double duration_s, const Surroundings& around, double reach);

  const JointState& state() const { return state_; }
  const IntegrationCounts& counts() const { return counts_; }

 private:
  struct Step {
    double position = 0;
    double velocity = 0;
    double acceleration = 0;
    double error = 0;  // over the tolerance
  };
  JointInstant instant(double since_begin_s, double since_commit, double position,
                       double velocity) const;
  double acceleration(double since_begin_s, double since_commit, double position, double velocity,
                      int direction);
  Step try_step(double h, double acceleration);
  bool slide(double duration_s);
  bool stick(double duration_s);
  void take(double h, const Step& step);
  double passes_standstill(double h, double acceleration, const Step& step) const;
  bool stop_within(double h, double acceleration);
  int starting_direction(double since_begin_s, double since_commit, int from);

  JointEquation& equation_;
  Tolerances tolerances_;
  const Surroundings* around_ = nullptr;
  JointState state_;
  IntegrationCounts counts_;
  double begin_ = 0;  // time at which the stretch begins
  double past_ = 0;   // s since then
  double next_step_s_ = 0;
  bool has_failed_ = false;
};

}  // namespace tribench::forward
