// SPDX-License-Identifier: MIT
#include "problems/preparation/recording_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "foundation/elementary.hpp"
#include "foundation/error.hpp"
#include "problems/friction_sign.hpp"
#include "problems/preparation/motion_check.hpp"
#include "problems/preparation/rigid_body.hpp"

namespace tribench {
namespace {

constexpr double kMuchExplained = 0.3;
constexpr double kSure = 10;      // standard errors, from which a story is refused
constexpr double kCertain = 5;    // standard errors of a gravity that explains much
constexpr double kNoPayload = 5;  // a factor beyond that, or below its inverse, is none's

}  // namespace

// Two quantities of different units are never subtracted.
void check_units(const PreparedRecording& out) {
  const Channel* gravity = out.data.find(Role::gravity_torque);
  const Channel* torque = out.data.find(Role::motor_torque);
  if (torque == nullptr) torque = out.data.find(Role::motor_current);
  if (gravity == nullptr || torque == nullptr || out.data.find(Role::friction_torque)) return;
  if (gravity->unit == torque->unit || torque->unit == "V") return;
  if (torque->unit == "A") {
    throw_bad_input(
        fmt::format("'{}' is in A and '{}' in {}", torque->name, gravity->name, gravity->unit),
        out.data.name,
        fmt::format("give --torque-constant K (N m/A at the joint, or K@motor with --gear-ratio), "
                    "or leave gravity out: --roles '{}=none'",
                    gravity->name));
  }
  const Channel* unknown = gravity->unit == "-" ? gravity : torque->unit == "-" ? torque : nullptr;
  if (unknown == nullptr) return;
  throw_bad_input(fmt::format("the unit of '{}' is not known", unknown->name), out.data.name,
                  fmt::format("say it: --roles '{}={}[N m]' (or N, A, V)", unknown->name,
                              role_name(unknown->role)));
}

void check_gravity_factor(const PreparedRecording& out, const DataOptions& options) {
  const Channel* gravity = out.data.find(Role::gravity_torque);
  const Channel* torque = out.data.find(Role::motor_torque);
  if (torque == nullptr) torque = out.data.find(Role::motor_current);
  if (gravity == nullptr || torque == nullptr || gravity->unit != torque->unit) return;
  const std::optional<GravityFactor> factor = gravity_factor(out.data);
  if (!factor || std::abs(factor->value) < kSure * factor->error) return;
  const double value = factor->value;
  const auto is = [&](double known) {
    return std::abs(elementary::log(std::abs(value) / known)) < kSameFactor;
  };
  const std::string what = fmt::format("'{}' goes into '{}' with the factor {:.3g}, not 1",
                                       gravity->name, torque->name, value);
  const double size = std::abs(value);
  const bool is_of_its_size = size < kNoPayload && size > 1 / kNoPayload;
  if (value < 0 && is_of_its_size) {
    throw_bad_input(what, out.data.name,
                    "one of the two has its sign turned: gravity is the torque that the motor has "
                    "to hold; turn it in the file, or let it be fitted: --gravity fit");
  }
  const std::optional<double> ratio = options.drive.gear_ratio;
  const bool is_ratio = ratio && !is(1) && (is(*ratio) || is(1 / *ratio));
  if (!is_ratio && is_of_its_size) return;
  // Of a gravity that is next to nothing it is the rest of the model that the factor tells.
  if (factor->explained < kMuchExplained) return;
  throw_bad_input(
      what, out.data.name,
      fmt::format("check their units (--roles COLUMN=ROLE[UNIT]), --torque-constant and "
                  "the side of the gear (@motor); a torque without gravity is a "
                  "friction_torque; gravity that is next to nothing may be left out: "
                  "--roles '{}=none'",
                  gravity->name));
}

namespace {

void refuse_turned_sign(const PreparedRecording& out, const RigidBody& body) {
  if (body.friction > -kSure * body.friction_error) return;
  throw_bad_input(
      fmt::format("friction opposes the velocity here ({:.3g} at the typical speed, inertia and "
                  "gravity taken off); it is expected positive with velocity",
                  body.friction),
      out.data.name, mend_of_sign(out.data.torques_flipped));
}

void add_rigid(PreparedRecording& out, const Channel& channel) {
  out.rigid.push_back(channel.name);
  out.data.channels.push_back(channel);
}

}  // namespace

void fit_gravity(PreparedRecording& out, Gravity gravity) {
  if (out.data.find(Role::friction_torque) != nullptr ||
      out.data.find(Role::gravity_torque) != nullptr) {
    if (gravity != Gravity::fit) return;
    throw_bad_input("a column declares the gravity torque, or there is a friction torque",
                    "--gravity fit", "leave --gravity out, or take the role away: COLUMN=none");
  }
  const std::optional<RigidBody> body = fit_rigid_body(out.data);
  if (!body) {
    if (gravity != Gravity::fit) return;
    throw_bad_input(
        "gravity cannot be fitted: it needs an angle that covers 0.3 rad or more, and "
        "a motor torque or current",
        "--gravity fit", "declare it: --roles COLUMN=gravity_torque[N m]");
  }
  refuse_turned_sign(out, *body);
  const bool much = body->explained > kMuchExplained && body->certainty > kCertain;
  if (gravity == Gravity::none) {
    if (much) {
      out.notes.push_back(
          fmt::format("sin and cos of the position explain {:.0f} % of what friction leaves: "
                      "--gravity fit takes that gravity off",
                      100 * body->explained));
    }
    return;
  }
  if (gravity == Gravity::automatic && !much) return;
  const std::vector<double> angle = out.data.find(Role::position)->values;
  const Channel* torque = out.data.find(Role::motor_torque);
  if (torque == nullptr) torque = out.data.find(Role::motor_current);
  Channel sine{"sin_q", "-", Role::none, {}, "sin(q)"};
  Channel cosine{"cos_q", "-", Role::none, {}, "cos(q)"};
  Channel load{"fitted_gravity",
               torque->unit,
               Role::gravity_torque,
               {},
               fmt::format("{}*sin(q) + {}*cos(q)", body->sine, body->cosine)};
  for (const double q : angle) {
    sine.values.push_back(elementary::sin(q));
    cosine.values.push_back(elementary::cos(q));
    load.values.push_back(body->sine * sine.values.back() + body->cosine * cosine.values.back());
  }
  out.notes.push_back(fmt::format(
      "gravity that no column declares is fitted with the base, g = {:.6g}*sin_q + {:.6g}*cos_q "
      "({:.4g} {} at most; it explains {:.0f} % of what friction and inertia leave){}",
      body->sine, body->cosine, std::sqrt(body->sine * body->sine + body->cosine * body->cosine),
      torque->unit, 100 * body->explained,
      gravity == Gravity::fit ? "" : ", as --gravity fit does; --gravity none leaves it out"));
  add_rigid(out, sine);
  add_rigid(out, cosine);
  out.data.channels.push_back(load);
  const Channel* a = out.data.find(Role::acceleration);
  if (a != nullptr && std::ranges::count(out.rigid, a->name) == 0) out.rigid.push_back(a->name);
}

}  // namespace tribench
