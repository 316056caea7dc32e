// SPDX-License-Identifier: MIT
#include "algorithms/effects/effect_library.hpp"

#include "problems/preparation/derived_channels.hpp"

namespace tribench::loop {
namespace {

// Grids are fractions of the signal's scale.
constexpr double kNarrowFall = 0.15;  // of the top speed

// A step of the load that is wider than this part of it is no step: it would pass for a gain.
constexpr double kWidestStep = 0.1;

EffectFamily asymmetry() {
  EffectFamily f{"asymmetry",
                 "E2",
                 "Coulomb and viscous friction that differ by direction",
                 "friction differs by direction",
                 "Armstrong-Helouvry 1991",
                 {}};
  f.atoms = {{{"1"}, {"half_gap"}},
             {{"abs(v)"}, {"viscous_half_gap"}},
             {{"1", "abs(v)"}, {"half_gap", "viscous_half_gap"}}};
  f.known_aliases = {{"sensor_offset",
                      "read the torque with the drive unpowered or the brake on, or turn the axis "
                      "free of gravity",
                      "half_gap"}};
  f.separate_by = {"R8"};
  return f;
}

EffectFamily stribeck() {
  EffectFamily f{"stribeck",
                 "E1",
                 "friction that falls from its breakaway level as speed grows",
                 "friction falls with speed near standstill",
                 "Armstrong-Helouvry 1991; Canudas de Wit 1995",
                 {}};
  // A wide one can be mistaken for a parabola of the speed: there friction has to fall.
  const ShapeTemplate narrow{"vs", "v", {0.02, 0.045, 0.09, 0.14}, 0.004, kNarrowFall, true};
  const ShapeTemplate wide{"vs", "v", {0.2, 0.4}, kNarrowFall, 0.5, true};
  const ShapeTemplate delta{"delta", "", {1, 2}, 0.5, 3};
  // In one direction alone a tail of less than 1 is viscous friction that differs by direction.
  const ShapeTemplate short_tail{"delta", "", {1, 2}, 1, 3};
  const std::string curve = "exp(-(abs(v)/vs)^delta)";
  f.atoms = {{{"sgn_v*" + curve}, {"excess"}, {narrow, delta}},
             {.columns = {"sgn_v*" + curve},
              .coefficients = {"excess"},
              .shapes = {wide, delta},
              .curve = SpeedCurve::falls},
             {.columns = {"sgn_v^2*" + curve},
              .coefficients = {"excess_half_gap"},
              .shapes = {narrow, delta},
              .by_direction = true}};
  for (const char* direction : {"sgn_v*(1 + sgn_v)/2*", "sgn_v*(1 - sgn_v)/2*"}) {
    f.atoms.push_back({.columns = {direction + curve},
                       .coefficients = {"excess"},
                       .shapes = {narrow, short_tail},
                       .one_way = true});
  }
  f.sanity = {{"excess", 1, 0, "breakaway friction below Coulomb friction"}};
  f.separate_by = {"R6"};
  return f;
}

EffectFamily nonlinear_viscous() {
  EffectFamily f{"nonlinear_viscous",
                 "E3",
                 "viscous friction that is not proportional to speed",
                 "viscous friction is not proportional to speed",
                 "Wolf and Iskandar 2018 (polynomial); Bittencourt 2010",
                 {}};
  f.atoms = {
      {{"v*abs(v)"}, {"quadratic"}},
      {{"v^3"}, {"cubic"}},
      {{"sgn_v*(abs(v)/vr)^n"}, {"power"}, {{"vr", "v", {1}, 1, 1}, {"n", "", {0.5, 4}, 0.3, 6}}},
      {{"sgn_v*(1 - exp(-abs(v)/v0))"}, {"saturating"}, {{"v0", "v", {0.2, 0.5}, 0.1, 3}}},
      {.columns = {"v^2"}, .coefficients = {"quadratic_half_gap"}, .by_direction = true},
      {.columns = {"abs(v)^3"}, .coefficients = {"cubic_half_gap"}, .by_direction = true},
      {.columns = {"1 - exp(-abs(v)/v0)"},
       .coefficients = {"saturating_half_gap"},
       .shapes = {{"v0", "v", {0.2, 0.5}, 0.1, 3}},
       .by_direction = true}};
  for (AtomTemplate& atom : f.atoms) atom.curve = SpeedCurve::rises;
  f.separate_by = {"R2"};
  return f;
}

// A gear carries the inertia behind it as it does the gravity, whichever of the two a table has
// taken off. Where both weigh alike at the fastest and heaviest the grid holds them so.
ShapeTemplate inertia_in_load() { return {std::string(kInertiaInLoad), "g/a", {0.3, 1}, 0.03, 10}; }

EffectFamily load_coulomb() {
  EffectFamily f{"load_coulomb",
                 "E4",
                 "Coulomb friction that grows with the load",
                 "Coulomb friction grows with the load",
                 "Bittencourt et al. 2010",
                 {}};
  f.atoms = {{{"sgn_v*abs(g)"}, {"mu"}},
             {{"sgn_v*abs(g + J*a)"}, {"mu"}, {inertia_in_load()}},
             {.columns = {"abs(g)"}, .coefficients = {"mu_half_gap"}, .by_direction = true}};
  f.sanity = {{"mu", 1, 0, "friction that falls as the load grows"}};
  f.separate_by = {"R3"};
  return f;
}

EffectFamily load_viscous() {
  EffectFamily f{"load_viscous",
                 "E7",
                 "viscous friction that grows with the load",
                 "viscous friction grows with the load",
                 "Bittencourt et al. 2010",
                 {}};
  f.atoms = {{{"v*abs(g)"}, {"mu_v"}},
             {{"v*abs(g + J*a)"}, {"mu_v"}, {inertia_in_load()}},
             {.columns = {"abs(v*g)"}, .coefficients = {"mu_v_half_gap"}, .by_direction = true}};
  f.separate_by = {"R3"};
  return f;
}

EffectFamily power_quadrant_gain() {
  EffectFamily f{
      "power_quadrant_gain",
      "E5",
      "torque in proportion to the load: efficiency that differs between driving and "
      "back-driving, or a load or torque constant that is off",
      "a torque follows the load: losses differ in back-driving, or the declared load or "
      "the torque constant is off",
      "Tadese et al. 2021",
      {}};
  f.atoms = {{{"g"}, {"gain"}}};
  // Losses are some percent; a declared mass or a torque constant may well be off by a third.
  f.sanity = {{"gain", 0, 0.5, "a load that is off by more than half"}};
  const std::string how =
      "known payload and a link-side torque sensor, or a standstill hold approached from both "
      "sides";
  f.known_aliases = {{"torque_constant", how}, {"mass_scale", how}};
  f.separate_by = {"R3", "R8"};
  return f;
}

EffectFamily power_quadrant_step() {
  EffectFamily f{"power_quadrant_step",
                 "E6",
                 "a loss that jumps where driving turns into back-driving",
                 "a loss jumps where driving turns into back-driving",
                 "Tadese et al. 2021",
                 {}};
  f.atoms = {{{"tanh(g/g0)"}, {"step"}, {{"g0", "g", {0.012, 0.05}, 0.003, kWidestStep}}}};
  f.separate_by = {"R3", "R8"};
  return f;
}

EffectFamily payload() {
  EffectFamily f{"payload",
                 "E14",
                 "a mass or its lever that the declared gravity lacks, or declares too much",
                 "the joint carries a mass that nobody declared",
                 "rigid-body mechanics",
                 {}};
  f.atoms = {{{"sin(q)", "cos(q)"}, {"sine", "cosine"}}};
  f.angular = true;
  f.changeable = true;
  f.known_aliases = {{"output_ripple (once a turn)", "a known payload (R3)"}};
  f.separate_by = {"R3"};
  return f;
}

// Where sin q does not bend over the range of motion, a mass pulls alike.
EffectFamily spring() {
  EffectFamily f{"spring",
                 "E16",
                 "torque that grows with the position: a spring, a cable, a hose",
                 "a spring, a cable or a hose pulls at the joint",
                 "mechanics; Duffing 1918 (cubic)",
                 {}};
  f.atoms = {{{"q"}, {"stiffness"}}, {{"q^3"}, {"stiffening"}}};
  f.separate_by = {"R3"};
  return f;
}

// Twice and three times the wave with this angle, or twice alone: what a wave that is no sine has
// beside itself.
AtomTemplate harmonics_of(const std::string& angle, std::vector<ShapeTemplate> shapes,
                          int most = 3) {
  AtomTemplate atom{{}, {}, std::move(shapes)};
  atom.beside_another = true;
  for (int k = 2; k <= most; ++k) {
    const std::string times = std::to_string(k);
    for (const char* wave : {"cos", "sin"}) {
      atom.columns.push_back(std::string(wave) + "(" + times + "*" + angle + ")");
      atom.coefficients.push_back(std::string(wave) + "_" + times);
    }
  }
  return atom;
}

// The wave with this angle where its phase or its size drifts: by w rad, up or down, while the
// campaign lasts.
AtomTemplate drifting(const std::string& angle, std::vector<ShapeTemplate> shapes) {
  shapes.push_back({.name = "t0", .scale = "t", .grid = {0}, .reference = true});
  shapes.push_back({"w", "1/t", {1.5}, 0.3, 6});
  AtomTemplate atom{{}, {}, std::move(shapes)};
  atom.beside_another = true;
  for (const char* slow : {"cos", "sin"}) {
    for (const char* wave : {"cos", "sin"}) {
      atom.columns.push_back(std::string(wave) + "(" + angle + ")*" + slow + "(w*(t - t0))");
      atom.coefficients.push_back(std::string(wave) + "_" + slow);
    }
  }
  return atom;
}

// The wave with this angle behind a lag of the first order: a controller that moves the joint
// steadily follows the wave up to the speed vr, beyond it the joint's inertia takes it.
AtomTemplate of_slow_motion(const std::string& angle, std::vector<ShapeTemplate> shapes) {
  shapes.push_back({"vr", "v", {0.15, 0.5}, 0.03, 3});
  const std::string cosine = "cos(" + angle + ")";
  const std::string sine = "sin(" + angle + ")";
  const std::string share = "/(1 + (v/vr)^2)";
  return {.columns = {"(" + cosine + " + v/vr*" + sine + ")" + share,
                      "(" + sine + " - v/vr*" + cosine + ")" + share},
          .coefficients = {"cosine", "sine"},
          .shapes = std::move(shapes),
          .beside_another = true,
          .last_resort = true};
}

EffectFamily output_ripple() {
  EffectFamily f{"output_ripple",
                 "E8",
                 "torque that repeats with the output's turn",
                 "torque repeats with the joint's angle",
                 "Tuttle 1992",
                 {}};
  for (int k = 2; k <= kMostWavesOfOutput; ++k) {
    const std::string angle = std::to_string(k) + "*q)";
    f.atoms.push_back({{"cos(" + angle, "sin(" + angle}, {"cosine", "sine"}});
  }
  for (int k = 2; k <= kMostWavesOfOutput; ++k) {
    const std::string angle = std::to_string(k) + "*q";
    f.atoms.push_back(harmonics_of(angle, {}, 3 * k <= 12 ? 3 : 2));
    f.atoms.push_back(drifting(angle, {}));
  }
  // Of the friction itself (a bearing or seal that runs out). Under a load that nobody has told it
  // would be load friction, too.
  for (int k = 1; k <= kMostWavesOfOutput; ++k) {
    const std::string angle = std::to_string(k) + "*q)";
    f.atoms.push_back({.columns = {"sgn_v*cos(" + angle, "sgn_v*sin(" + angle},
                       .coefficients = {"friction_cosine", "friction_sine"},
                       .last_resort = true});
  }
  f.known_aliases = {{"load-dependent friction", "R3", "friction_cosine", "g"}};
  f.angular = true;
  f.separate_by = {"R2", "R3"};
  return f;
}

EffectFamily gear_ripple() {
  EffectFamily f{"gear_ripple",
                 "E9",
                 "torque that repeats with the turn of the wave generator, the motor or the screw",
                 "torque repeats with the motor's turn",
                 "Taghirad and Belanger 1998; Ghorbel et al. 2001",
                 {}};
  const ShapeTemplate ratio{
      .name = "N", .scale = "", .grid = {}, .values = ShapeValues::gear_ratios};
  for (const char* k : {"1", "2", "4"}) {
    const std::string angle = std::string(k) + "*N*q)";
    f.atoms.push_back({{"cos(" + angle, "sin(" + angle}, {"cosine", "sine"}, {ratio}});
    f.atoms.push_back({{"sgn_v*cos(" + angle, "sgn_v*sin(" + angle}, {"cosine", "sine"}, {ratio}});
    f.atoms.push_back(drifting(std::string(k) + "*N*q", {ratio}));
    f.atoms.push_back(of_slow_motion(std::string(k) + "*N*q", {ratio}));
  }
  f.atoms.push_back(harmonics_of("N*q", {ratio}));
  f.separate_by = {"R6"};
  return f;
}

EffectFamily temperature() {
  EffectFamily f{"temperature",
                 "E10",
                 "friction that changes with temperature",
                 "friction changes with temperature",
                 "Bittencourt 2012; Wolf and Iskandar 2018",
                 {}};
  const ShapeTemplate reference{
      .name = "T0", .scale = "T", .grid = {0}, .low = 0, .high = 0, .reference = true};
  f.atoms = {
      {{"v*(T - T0)"}, {"viscous_slope"}, {reference}},
      {{"sgn_v*(T - T0)"}, {"coulomb_slope"}, {reference}},
      {{"v*exp(-(T - T0)/Tv)"}, {"viscous_decay"}, {reference, {"Tv", "T", {0.5, 1.0}, 0.2, 4}}},
      {.columns = {"abs(v)*(T - T0)"},
       .coefficients = {"viscous_slope_half_gap"},
       .shapes = {reference},
       .by_direction = true},
      {.columns = {"T - T0"},
       .coefficients = {"coulomb_slope_half_gap"},
       .shapes = {reference},
       .by_direction = true}};
  f.sanity = {{"viscous_slope", -1, 0, "viscous friction that grows with temperature"},
              {"viscous_decay", 1, 0, "viscous friction that grows with temperature"}};
  f.separate_by = {"R5"};
  return f;
}

EffectFamily drift() {
  EffectFamily f{"drift",
                 "E11",
                 "friction or a sensor that changes through the campaign",
                 "friction changes through the campaign",
                 "Bittencourt and Axelsson 2013",
                 {}};
  const ShapeTemplate reference{
      .name = "t0", .scale = "t", .grid = {0}, .low = 0, .high = 0, .reference = true};
  f.atoms = {{{"sgn_v*(t - t0)"}, {"coulomb_rate"}, {reference}},
             {{"v*(t - t0)"}, {"viscous_rate"}, {reference}},
             {{"t - t0"}, {"offset_rate"}, {reference}},
             // Running in: fast at first.
             {{"sgn_v*exp(-(t - t0)/tr)"},
              {"coulomb_run_in"},
              {reference, {"tr", "t", {0.15, 0.4}, 0.03, 2}}},
             {.columns = {"abs(v)*(t - t0)"},
              .coefficients = {"viscous_rate_half_gap"},
              .shapes = {reference},
              .by_direction = true}};
  f.separate_by = {"R1", "R5"};
  return f;
}

EffectFamily hysteresis() {
  EffectFamily f{"hysteresis",
                 "E12",
                 "presliding: friction that builds up after a reversal",
                 "friction builds up with the distance after a reversal",
                 "Dahl 1968; LuGre 1995",
                 {}};
  // A movement that starts in motion has its bristles bent already, or (a joint held by a brake)
  // not yet: the data say which.
  for (const std::string_view name : {std::string_view("d"), kSeenDistance}) {
    const std::string distance(name);
    const ShapeTemplate lambda{"lambda", distance, {0.0001, 0.0003, 0.001, 0.004, 0.01, 0.03},
                               0.00003,  0.1,      true};
    f.atoms.push_back({{"sgn_v*exp(-" + distance + "/lambda)"}, {"presliding"}, {lambda}});
    f.atoms.push_back({.columns = {"exp(-" + distance + "/lambda)"},
                       .coefficients = {"presliding_half_gap"},
                       .shapes = {lambda},
                       .by_direction = true});
  }
  f.sanity = {{"presliding", -1, 0, "friction that falls with the distance after a reversal"}};
  // Both are transients over the path since the torque on the gear turned.
  f.known_aliases = {{"backlash", "load the joint so that its gear stays on one flank (R3)"}};
  f.separate_by = {"R4"};
  return f;
}

EffectFamily lag() {
  EffectFamily f{"lag",
                 "E13",
                 "friction that follows the velocity late",
                 "friction follows the velocity late near standstill",
                 "Hess and Soom 1990",
                 {}};
  // Where the joint is sped up or slowed down: the sign of what a disturbance shakes it by is that
  // of the disturbance.
  f.atoms = {{{"exp(-abs(v)/vl)*(sgn(a - al) + sgn(a + al))/2"},
              {"lag"},
              {{"vl", "v", {0.07, 0.15, 0.3}, 0.02, 0.6}, {"al", "a", {0.03}}}}};
  // Friction of the velocity as it was (a pure time lag). Its viscous part is next to an inertia,
  // and no lag by itself.
  for (const int lag_ms : kLags_ms) {
    const std::string late = LateChannel::velocity(lag_ms).name();
    const std::string sign = "tanh(" + late + "/vw) - tanh(v/vw)";
    const ShapeTemplate width = {"vw", "v", {0.025, 0.07, 0.2}, 0.02, 0.6};
    f.atoms.push_back({{sign}, {"late"}, {width}});
    f.atoms.push_back({.columns = {sign, late + " - v"},
                       .coefficients = {"late", "late_viscous"},
                       .shapes = {width},
                       .without_inertia = true});
  }
  // Friction that settles on its value, as behind a first-order filter.
  for (const int time_constant_ms : kSettling_ms) {
    f.atoms.push_back({{LateChannel::sign(time_constant_ms).name() + " - sgn_v"}, {"late"}, {}});
  }
  for (const std::string_view name : {"lag", "late"}) {
    f.sanity.push_back({std::string(name), 1, 0, "friction that runs ahead of the velocity"});
  }
  f.separate_by = {"R4"};
  return f;
}

EffectFamily inertia() {
  EffectFamily f{"inertia",
                 "E15",
                 "an inertia that the rigid body lacks, or has too much of",
                 "the rigid body's inertia is off",
                 "rigid-body mechanics",
                 {}};
  f.atoms = {{{"a"}, {"inertia"}}};
  f.changeable = true;
  f.known_aliases = {{"lag of viscous friction", "change the inertia with a payload (R3, R4)"}};
  f.separate_by = {"R4", "R3"};
  return f;
}

EffectFamily coupling() {
  EffectFamily f{"coupling",
                 "E18",
                 "torque from the motion of another joint",
                 "another joint's motion reaches this one",
                 "rigid-body mechanics",
                 {}};
  f.atoms = {{{"v2"}, {"viscous"}},
             {{"a2"}, {"inertial"}},
             {{"v*v2"}, {"coriolis"}},
             {{"v2^2"}, {"centrifugal"}}};
  f.separate_by = {"R7"};
  return f;
}

EffectFamily titled(EffectFamily family, std::string title) {
  family.title = std::move(title);
  return family;
}

}  // namespace

const std::vector<EffectFamily>& builtin_effects() {
  static const std::vector<EffectFamily> kEffects = {
      titled(asymmetry(), "difference between the directions"),
      titled(stribeck(), "Stribeck effect"),
      titled(nonlinear_viscous(), "nonlinear viscous friction"),
      titled(load_coulomb(), "load-dependent Coulomb friction"),
      titled(load_viscous(), "load-dependent viscous friction"),
      titled(power_quadrant_gain(), "torque in proportion to the load"),
      titled(power_quadrant_step(), "loss step in back-driving"),
      titled(payload(), "payload error"),
      titled(spring(), "spring"),
      titled(output_ripple(), "ripple of the joint's turn"),
      titled(gear_ripple(), "gear ripple"),
      titled(temperature(), "temperature"),
      titled(drift(), "drift"),
      titled(hysteresis(), "hysteresis after reversals"),
      titled(lag(), "friction lag"),
      titled(inertia(), "inertia error"),
      titled(coupling(), "coupling to another joint")};
  return kEffects;
}

std::vector<std::string> builtin_effect_names() {
  std::vector<std::string> names;
  for (const EffectFamily& family : builtin_effects()) names.push_back(family.name);
  return names;
}

std::string experiment_text(std::string_view rule) {
  if (rule == "R1") return "repeat at least 5 settings twice, hours apart";
  if (rule == "R2") return "move both ways over the same stroke in the same posture";
  if (rule == "R3") return "use two postures or a known payload";
  if (rule == "R4")
    return "run reversals and a two-tone movement that covers speed and acceleration";
  if (rule == "R5") return "take the movements in random order with one cool-down";
  if (rule == "R6") return "pass slowly, with at least 20 samples in a quarter of a motor turn";
  if (rule == "R7") return "move the other joints one at a time, in at least 20 stretches";
  if (rule == "R8") return "hold still after an approach from either side";
  if (rule == "R9") return "record at least 30 movements";
  return std::string(rule);
}

}  // namespace tribench::loop
