// SPDX-License-Identifier: MIT
//
// Movements of a plain Coulomb and viscous joint whose torques each have an offset of their own
// that no signal tells: a sensor whose zero jumps.
#pragma once

#include <cstdint>
#include <string>

#include "foundation/random.hpp"
#include "problems/dataset.hpp"

namespace tribench::testing {

// To and fro in turn, each twice from 0.2 to 1 rad/s; noise of 0.15 N m a row. offset: standard
// deviation, N m.
inline Dataset movements_with_offsets(int movements, double offset, std::uint64_t seed) {
  constexpr int kRows = 700;  // of a movement
  RandomStream random(seed);
  Dataset data;
  data.channels = {{"time", "s", Role::time, {}},
                   {"v", "rad/s", Role::velocity, {}},
                   {"tau_f", "N m", Role::friction_torque, {}}};
  for (int m = 0; m < movements; ++m) {
    data.movement_names.push_back(std::to_string(m));
    const double way = m % 2 == 0 ? 1 : -1;
    const double own = offset * random.normal();
    for (int i = 0; i < kRows; ++i) {
      const double v = way * (0.2 + 0.8 * (i % 350) / 350.0);
      data.movement.push_back(m);
      data.channels[0].values.push_back(100 * m + 0.01 * i);
      data.channels[1].values.push_back(v);
      data.channels[2].values.push_back(8 * way + 14 * v + own + 0.15 * random.normal());
    }
  }
  return data;
}

}  // namespace tribench::testing
