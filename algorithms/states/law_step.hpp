// SPDX-License-Identifier: MIT
//
// The laws of state_law.hpp over one step, once for all kinds of number: double and float, and
// double with derivatives (dual.hpp). Only this room includes it.
//
// T is the kind of the state and its parameters, D that of the drives. A step is cut where v turns;
// in each part z goes to a z + c with 0 <= a <= 1 or, held, to clamp(z + dx).
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "algorithms/states/state_law.hpp"

namespace tribench::states {

double exponential(double x);
float exponential(float x);  // the evaluator's, for single precision

template <typename T>
T magnitude(const T& x) {
  return x < T(0) ? -x : x;
}

template <typename T>
T sign_of(const T& x) {
  return T(x > T(0) ? 1 : x < T(0) ? -1 : 0);
}

// A part of a step: v keeps its sign.
template <typename D>
struct Part {
  D speed{};  // mean, signed
  D travel{};
  D seconds{};
};

// The parts of a step from v0 to v1; returns how many.
template <typename D>
int parts_of_step(const D& v0, const D& v1, const D& dt, Part<D> parts[2]) {
  const D half = static_cast<D>(0.5);
  const D zero(0);
  if ((v0 < zero && v1 > zero) || (v0 > zero && v1 < zero)) {
    const D first = dt * (v0 / (v0 - v1));
    const D second = dt - first;
    parts[0] = {half * v0, half * v0 * first, first};
    parts[1] = {half * v1, half * v1 * second, second};
    return 2;
  }
  const D mean = half * (v0 + v1);
  parts[0] = {mean, mean * dt, dt};
  return 1;
}

// The deflection that bristles slide at: low + (high - low) exp(-(v/vs)^2).
template <typename T, typename D>
T sliding_curve(const T& low, const T& high, const T& velocity_scale, const D& speed) {
  const T ratio = speed / velocity_scale;
  return low + (high - low) * exponential(-(ratio * ratio));
}

// Bristles that travel `travel` and slide at g: z' = v - |v| z / g, exactly.
template <typename T, typename D>
T slid(const T& z, const D& travel, const T& g) {
  const T e = exponential(-(magnitude(travel) / g));
  return e * z + sign_of(travel) * g * (T(1) - e);
}

template <typename T>
T held(const T& z, const T& limit) {
  return std::clamp(z, -limit, limit);
}

template <typename T, typename D>
void advance_dahl(std::span<const T> p, T& z, const D& v0, const D& v1, const D& dt) {
  Part<D> parts[2];
  const int count = parts_of_step(v0, v1, dt, parts);
  for (int k = 0; k < count; ++k) z = held(slid(z, parts[k].travel, p[0]), p[0]);
}

template <typename T, typename D>
void advance_lugre(std::span<const T> p, T& z, const D& v0, const D& v1, const D& dt) {
  Part<D> parts[2];
  const int count = parts_of_step(v0, v1, dt, parts);
  const T most = std::max(p[0], p[1]);
  for (int k = 0; k < count; ++k) {
    const T g = sliding_curve(p[0], p[1], p[2], parts[k].speed);
    z = held(slid(z, parts[k].travel, g), most);
  }
}

// slip and backlash: the rate may hold a parameter.
template <typename T, typename D>
void advance_held(const T& limit, T& z, const D& rate0, const D& rate1, const D& dt) {
  Part<D> parts[2];
  const int count = parts_of_step(rate0, rate1, dt, parts);
  for (int k = 0; k < count; ++k) z = held(T(z + parts[k].travel), limit);
}

// e: how much of its distance from the level an element keeps that slips over the whole part.
template <typename T, typename D>
T gms_decay(std::span<const T> p, const T& level, const D& seconds) {
  return exponential(-(seconds * p[0] / (level * p[3])));
}

// `decay` gives e; it is asked only where the element slips.
template <typename T, typename D, typename Decay>
void advance_gms_part(const T& most, BasicStateMemory<T>& memory, const D& travel, const T& level,
                      const Decay& decay) {
  const D direction = sign_of(travel);
  if (direction == D(0)) return;
  if (memory.slips && memory.z * direction < T(0)) memory.slips = false;  // v has turned
  if (!memory.slips) {
    const T next = memory.z + travel;
    if (next * direction < level) {
      memory.z = held(next, most);
      return;
    }
    memory.slips = true;
    if (memory.z * direction < level) {  // reached on the way; from there on it is in balance
      memory.z = direction * level;
      return;
    }
  }
  const T e = decay();
  memory.z = held(T(e * memory.z + direction * level * (T(1) - e)), most);
}

template <typename T, typename D>
void advance_gms(std::span<const T> p, BasicStateMemory<T>& memory, const D& v0, const D& v1,
                 const D& dt) {
  Part<D> parts[2];
  const int count = parts_of_step(v0, v1, dt, parts);
  const T most = std::max(p[0], p[1]);
  for (int k = 0; k < count; ++k) {
    const T level = sliding_curve(p[0], p[1], p[2], parts[k].speed);
    advance_gms_part(most, memory, parts[k].travel, level,
                     [&] { return gms_decay(p, level, parts[k].seconds); });
  }
}

// Of a lagged value: a mean of the three with weights that are not negative, which rounding must
// not leave.
template <typename T, typename D>
T between(const T& next, const T& z, const D& x0, const D& x1) {
  const T low = std::min(z, T(std::min(x0, x1)));
  const T high = std::max(z, T(std::max(x0, x1)));
  return std::clamp(next, low, high);
}

// z' = (x - z) / T while x runs from x0 to x1, exactly.
template <typename T, typename D>
void advance_lag(std::span<const T> p, T& z, const D& x0, const D& x1, const D& dt) {
  const T r = dt / p[0];
  if (!(r > T(0))) return;
  const T e = exponential(-r);
  const T next = x1 + e * (z - x0) - (x1 - x0) * ((T(1) - e) / r);
  z = between(next, z, x0, x1);
}

template <typename D>
D power_of(const BasicDrive<D>& drive) {
  return magnitude(drive.velocity * drive.load);
}

template <typename T, typename D>
void advance_by_law(StateLaw law, std::span<const T> p, BasicStateMemory<T>& memory,
                    const BasicDrive<D>& from, const BasicDrive<D>& to, const D& dt) {
  switch (law) {
    case StateLaw::lag:
      return advance_lag(p, memory.z, from.velocity, to.velocity, dt);
    case StateLaw::warmth:
      return advance_lag(p, memory.z, power_of(from), power_of(to), dt);
    case StateLaw::dahl:
      return advance_dahl(p, memory.z, from.velocity, to.velocity, dt);
    case StateLaw::lugre:
      return advance_lugre(p, memory.z, from.velocity, to.velocity, dt);
    case StateLaw::slip:
      return advance_held(p[0], memory.z, from.velocity, to.velocity, dt);
    case StateLaw::backlash:
      return advance_held(p[0], memory.z, T(from.velocity + p[1] * from.load),
                          T(to.velocity + p[1] * to.load), T(dt));
    case StateLaw::gms:
      return advance_gms(p, memory, from.velocity, to.velocity, dt);
  }
}

}  // namespace tribench::states
