// SPDX-License-Identifier: MIT
#include "problems/friction/law.hpp"

#include <fmt/format.h>

#include <cmath>

#include "foundation/elementary.hpp"
#include "foundation/sign.hpp"

namespace tribench {
namespace {

// Half the sum and half the difference of the two directions: with s = +-1,
// s F(direction) = even s + odd.
struct Pair {
  double even;
  double odd;
};
Pair halves(double positive, double negative) {
  return {(positive + negative) / 2, (positive - negative) / 2};
}

// The averaged curve with what the load adds; step: between -1 and 1, from one quadrant to the
// other.
double loaded(const FrictionLaw& law, double averaged_nm, double sign, double gravity_nm,
              double step) {
  return averaged_nm + sign * law.load_coulomb * (std::abs(gravity_nm) - law.mean_load_nm) +
         law.quadrant_gain * gravity_nm + law.quadrant_step_nm * step;
}

}  // namespace

double Branch::at(double speed_rad_s) const {
  const double square = speed_rad_s * speed_rad_s;
  return coulomb_nm + viscous * speed_rad_s - quartic_loss * square * square;
}

double FrictionLaw::averaged_at(double velocity_rad_s) const {
  const double s = sign(velocity_rad_s);
  return s * (s < 0 ? negative : positive).at(std::abs(velocity_rad_s));
}

double FrictionLaw::at(double velocity_rad_s, double gravity_nm) const {
  return loaded(*this, averaged_at(velocity_rad_s), sign(velocity_rad_s), gravity_nm,
                elementary::tanh(gravity_nm / quadrant_width_nm));
}

std::vector<double> FrictionLaw::at(double velocity_rad_s,
                                    std::span<const double> gravity_nm) const {
  const double s = sign(velocity_rad_s);
  const double averaged = averaged_at(velocity_rad_s);
  std::vector<double> out(gravity_nm.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = gravity_nm[i] / quadrant_width_nm;
  elementary::tanh_of_each(out);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = loaded(*this, averaged, s, gravity_nm[i], out[i]);
  }
  return out;
}

std::string FrictionLaw::formula(bool with_load, double offset_nm) const {
  const Pair f0 = halves(positive.coulomb_nm, negative.coulomb_nm);
  const Pair f1 = halves(positive.viscous, negative.viscous);
  const Pair f4 = halves(positive.quartic_loss, negative.quartic_loss);
  const double level = with_load ? f0.even - load_coulomb * mean_load_nm : f0.even;
  std::string text = fmt::format("{}*sgn_qd + {} + ({} + {}*sgn_qd)*qd - ({}*sgn_qd + {})*qd^4",
                                 level, f0.odd + offset_nm, f1.even, f1.odd, f4.even, f4.odd);
  if (with_load) {
    text += fmt::format(" + {}*sgn_qd*sgn_g*g + {}*g + {}*tanh(g/{})", load_coulomb, quadrant_gain,
                        quadrant_step_nm, quadrant_width_nm);
  }
  return text;
}

double ripple_at(std::span<const Harmonic> harmonics, double position_rad) {
  double sum = 0;
  for (const Harmonic& harmonic : harmonics) {
    sum +=
        harmonic.amplitude_nm * elementary::cos(harmonic.order * position_rad + harmonic.phase_rad);
  }
  return sum;
}

std::vector<double> ripple_at(std::span<const Harmonic> harmonics,
                              std::span<const double> positions_rad) {
  std::vector<double> sums(positions_rad.size(), 0.0);
  std::vector<double> wave(positions_rad.size());
  for (const Harmonic& harmonic : harmonics) {
    for (std::size_t i = 0; i < wave.size(); ++i) {
      wave[i] = harmonic.order * positions_rad[i] + harmonic.phase_rad;
    }
    elementary::cos_of_each(wave);
    for (std::size_t i = 0; i < wave.size(); ++i) sums[i] += harmonic.amplitude_nm * wave[i];
  }
  return sums;
}

}  // namespace tribench
