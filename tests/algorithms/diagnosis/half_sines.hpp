// SPDX-License-Identifier: MIT
//
// A joint that swings in half sines, one way and the other, over a torque that depends on the
// place: what tests of this room look at.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <string>

#include "foundation/random.hpp"
#include "problems/preparation/observations.hpp"
#include "problems/reading/csv.hpp"

namespace tribench::loop {

struct HalfSines {
  int movements;
  int rows;  // of each, its ends among them
  std::uint64_t seed;
};

inline constexpr double kHalfSinesNoise = 0.25;  // N m

inline Observations half_sines_over(const HalfSines& how,
                                    const std::function<double(double)>& torque_of) {
  RandomStream random(how.seed);
  std::string text = "movement,q,v,friction_torque_Nm\n";
  for (int m = 0; m < how.movements; ++m) {
    const double s = m % 2 == 0 ? 1 : -1;
    const double w = random.uniform(0.7, 2.5);
    const double reach = random.uniform(0.9, 1.3);
    for (int i = 1; i < how.rows; ++i) {
      const double phase = std::numbers::pi * i / how.rows;
      const double q = -s * reach * std::cos(phase);
      const double v = s * reach * w * std::sin(phase);
      const double torque = 4 * s + 6 * v + torque_of(q) + kHalfSinesNoise * random.normal();
      text += fmt::format("{},{},{},{}\n", m, q, v, torque);
    }
  }
  return observe(parse_csv(text, "half_sines.csv").data);
}

}  // namespace tribench::loop
