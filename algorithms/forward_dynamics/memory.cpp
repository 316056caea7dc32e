// SPDX-License-Identifier: MIT
#include "algorithms/forward_dynamics/memory.hpp"

#include <fmt/format.h>

#include <variant>
#include <vector>

#include "foundation/elementary.hpp"
#include "foundation/error.hpp"
#include "foundation/sign.hpp"
#include "problems/preparation/derived_channels.hpp"

namespace tribench::forward {
namespace {

// A channel that is computed row by row: the trial of a step is a row given to a copy.
template <typename Channel, typename Next>
class ChannelMemory : public Memory {
 public:
  ChannelMemory(Channel channel, Next next) : channel_(channel), next_(next) {}

  void begin(const Reached& at) override {
    channel_.start_movement();
    next_(channel_, 0.0, at);
  }
  double value_at(double dt_s, const Reached& at) const override {
    Channel tried = channel_;
    return next_(tried, dt_s, at);
  }
  void commit(double dt_s, const Reached& at) override { next_(channel_, dt_s, at); }

 private:
  Channel channel_;
  Next next_;
};

template <typename Channel, typename Next>
std::unique_ptr<Memory> make_memory(Channel channel, Next next) {
  return std::make_unique<ChannelMemory<Channel, Next>>(channel, next);
}

double value_of(const Binding& binding, const Reached& at) {
  switch (binding.source) {
    case Source::position:
      return at.position;
    case Source::velocity:
      return at.velocity;
    case Source::direction:
      return sign(at.velocity);
    case Source::sine:
      return elementary::sin(at.position);
    case Source::cosine:
      return elementary::cos(at.position);
    case Source::time:
      return at.time;
    case Source::motor_torque:
      return at.motor_torque;
    case Source::gravity:
      return at.gravity;
    case Source::gravity_sign:
      return sign(at.gravity);
    case Source::recorded:
      return at.recorded[binding.place];
    case Source::recorded_sign:
      return sign(at.recorded[binding.place]);
    case Source::acceleration:
    case Source::memory:
      break;
  }
  return 0;
}

class DeclaredState : public Memory {
 public:
  DeclaredState(StateDeclaration state, std::span<const Binding> drives)
      : state_(std::move(state)), drives_(drives.begin(), drives.end()) {}

  void begin(const Reached& at) override {
    drive_ = drive_of(at);
    memory_ = state_at_rest(state_.law, drive_);
  }
  double value_at(double dt_s, const Reached& at) const override {
    StateMemory tried = memory_;
    step(tried, dt_s, drive_of(at));
    return tried.z;
  }
  void commit(double dt_s, const Reached& at) override {
    const StateDrive now = drive_of(at);
    step(memory_, dt_s, now);
    drive_ = now;
  }

 private:
  StateDrive drive_of(const Reached& at) const {
    StateDrive drive;
    if (!drives_.empty()) drive.velocity = value_of(drives_[0], at);
    if (drives_.size() > 1) drive.load = value_of(drives_[1], at);
    return drive;
  }
  void step(StateMemory& memory, double dt_s, const StateDrive& to) const {
    if (dt_s > 0) {
      advance<double>(state_.law, std::span<const double>(state_.parameters), memory, drive_, to,
                      dt_s);
    }
  }

  StateDeclaration state_;
  std::vector<Binding> drives_;
  StateMemory memory_;
  StateDrive drive_;
};

}  // namespace

std::unique_ptr<Memory> memory_of(const StateDeclaration& state, std::span<const Binding> drives) {
  for (const Binding& drive : drives) {
    if (drive.source != Source::acceleration && drive.source != Source::memory) continue;
    throw_bad_input(fmt::format("the state '{}' is driven by {}", state.name,
                                drive.source == Source::memory ? "what is itself a memory"
                                                               : "the acceleration"),
                    state.name, "drive it by the velocity, the position or a recorded column");
  }
  return std::make_unique<DeclaredState>(state, drives);
}

std::unique_ptr<Memory> memory_of(std::string_view name) {
  if (loop::is_distance(name)) {
    return make_memory(loop::DistanceSinceReversal(loop::PathFrom::position),
                       [](loop::DistanceSinceReversal& channel, double dt_s, const Reached& at) {
                         return channel.next(at.velocity, at.position, dt_s);
                       });
  }
  const auto late = loop::LateChannel::of(name);
  if (!late) return nullptr;
  return std::visit(
      [](auto memory) {
        return make_memory(memory, [](decltype(memory)& channel, double dt_s, const Reached& at) {
          return channel.next(at.velocity, dt_s);
        });
      },
      late->memory());
}

}  // namespace tribench::forward
