// SPDX-License-Identifier: MIT
#include "algorithms/states/state_code.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "algorithms/states/exp_code.hpp"

namespace tribench {
namespace {

// A piece of text and what has to stand before it.
struct Piece {
  std::string_view name;
  std::string_view needs;  // names, each behind a blank
  std::string_view text;
};

constexpr std::array<Piece, 12> kC = {{
    {"sign", "", R"(/* -1, 0 or 1; NaN of NaN. */
static inline $R $Nsign($R x) { return x != x ? x : ($R)((x > 0) - (x < 0)); }

)"},
    {"clamp", "", R"(static inline $R $Nclamp($R x, $R low, $R high) {
  return x < low ? low : (high < x ? high : x);
}

)"},
    {"parts", "", R"(/* The parts of a step in which v keeps its sign. */
static inline int $Nparts($R v0, $R v1, $R dt, $R *speed, $R *travel, $R *seconds) {
  if ((v0 < 0 && v1 > 0) || (v0 > 0 && v1 < 0)) {
    seconds[0] = dt * (v0 / (v0 - v1));
    seconds[1] = dt - seconds[0];
    speed[0] = ($R)0.5 * v0;
    speed[1] = ($R)0.5 * v1;
    travel[0] = speed[0] * seconds[0];
    travel[1] = speed[1] * seconds[1];
    return 2;
  }
  seconds[0] = dt;
  speed[0] = ($R)0.5 * (v0 + v1);
  travel[0] = speed[0] * dt;
  return 1;
}

)"},
    {"curve", "", R"(static inline $R $Ncurve($R low, $R high, $R scale, $R speed) {
  const $R ratio = speed / scale;
  return low + (high - low) * $Nexp(-(ratio * ratio));
}

)"},
    {"slid", " sign", R"(static inline $R $Nslid($R z, $R travel, $R g) {
  const $R e = $Nexp(-(fabs$f(travel) / g));
  return e * z + $Nsign(travel) * g * (($R)1 - e);
}

)"},
    {"lag", " clamp", R"(static inline $R $Nlag($R z, $R x0, $R x1, $R dt, $R time_constant) {
  const $R r = dt / time_constant;
  $R e, next, low, high;
  if (!(r > 0)) return z;
  e = $Nexp(-r);
  next = x1 + e * (z - x0) - (x1 - x0) * ((($R)1 - e) / r);
  low = x1 < x0 ? x1 : x0;
  high = x0 < x1 ? x1 : x0;
  return $Nclamp(next, low < z ? low : z, z < high ? high : z);
}

)"},
    {"dahl", " clamp slid parts",
     R"(static inline $R $Ndahl($R z, $R v0, $R v1, $R dt, $R sliding) {
  $R speed[2], travel[2], seconds[2];
  const int parts = $Nparts(v0, v1, dt, speed, travel, seconds);
  int k;
  for (k = 0; k < parts; ++k) z = $Nclamp($Nslid(z, travel[k], sliding), -sliding, sliding);
  return z;
}

)"},
    {"lugre", " clamp slid parts curve",
     R"(static inline $R $Nlugre($R z, $R v0, $R v1, $R dt, $R sliding, $R breakaway, $R stribeck) {
  const $R most = sliding < breakaway ? breakaway : sliding;
  $R speed[2], travel[2], seconds[2];
  const int parts = $Nparts(v0, v1, dt, speed, travel, seconds);
  int k;
  for (k = 0; k < parts; ++k) {
    const $R g = $Ncurve(sliding, breakaway, stribeck, speed[k]);
    z = $Nclamp($Nslid(z, travel[k], g), -most, most);
  }
  return z;
}

)"},
    {"slip", " clamp parts", R"(static inline $R $Nslip($R z, $R v0, $R v1, $R dt, $R limit) {
  $R speed[2], travel[2], seconds[2];
  const int parts = $Nparts(v0, v1, dt, speed, travel, seconds);
  int k;
  for (k = 0; k < parts; ++k) z = $Nclamp(z + travel[k], -limit, limit);
  return z;
}

)"},
    {"gms", " clamp parts curve sign",
     R"(static inline $R $Ngms($R z, int *slips, $R v0, $R v1, $R dt, $R limit, $R breakaway, $R stribeck,
                $R attraction) {
  const $R most = limit < breakaway ? breakaway : limit;
  $R speed[2], travel[2], seconds[2];
  const int parts = $Nparts(v0, v1, dt, speed, travel, seconds);
  int k;
  for (k = 0; k < parts; ++k) {
    const $R direction = $Nsign(travel[k]);
    const $R level = $Ncurve(limit, breakaway, stribeck, speed[k]);
    $R e;
    if (direction == 0) continue;
    if (*slips && z * direction < 0) *slips = 0;
    if (!*slips) {
      const $R next = z + travel[k];
      if (next * direction < level) {
        z = $Nclamp(next, -most, most);
        continue;
      }
      *slips = 1;
      if (z * direction < level) {
        z = direction * level;
        continue;
      }
    }
    e = $Nexp(-(seconds[k] * limit / (level * attraction)));
    z = $Nclamp(e * z + direction * level * (($R)1 - e), -most, most);
  }
  return z;
}

)"},
    {"backlash", " slip",
     R"(static inline $R $Nbacklash($R z, $R v0, $R v1, $R l0, $R l1, $R dt, $R half_gap, $R drift) {
  return $Nslip(z, v0 + drift * l0, v1 + drift * l1, dt, half_gap);
}

)"},
    {"warmth", " lag",
     R"(static inline $R $Nwarmth($R z, $R v0, $R v1, $R l0, $R l1, $R dt, $R time_constant) {
  return $Nlag(z, fabs$f(v0 * l0), fabs$f(v1 * l1), dt, time_constant);
}

)"},
}};

constexpr std::array<Piece, 12> kPython = {{
    {"sign", "", R"(def _sign(x):
    return float(x > 0) - float(x < 0)


)"},
    {"clamp", "", R"(def _clamp(x, low, high):
    return low if x < low else high if high < x else x


)"},
    {"parts", "", R"(def _parts(v0, v1, dt):
    if (v0 < 0 < v1) or (v0 > 0 > v1):
        first = dt * (v0 / (v0 - v1))
        second = dt - first
        return [(0.5 * v0, 0.5 * v0 * first, first), (0.5 * v1, 0.5 * v1 * second, second)]
    return [(0.5 * (v0 + v1), 0.5 * (v0 + v1) * dt, dt)]


)"},
    {"curve", "", R"(def _curve(low, high, scale, speed):
    return low + (high - low) * math.exp(-((speed / scale) * (speed / scale)))


)"},
    {"slid", " sign", R"(def _slid(z, travel, g):
    e = math.exp(-(abs(travel) / g))
    return e * z + _sign(travel) * g * (1.0 - e)


)"},
    {"lag", " clamp", R"(def _lag(z, x0, x1, dt, time_constant):
    r = dt / time_constant
    if not r > 0:
        return z
    e = math.exp(-r)
    after = x1 + e * (z - x0) - (x1 - x0) * ((1.0 - e) / r)
    return _clamp(after, min(z, x0, x1), max(z, x0, x1))


)"},
    {"dahl", " clamp slid parts", R"(def _dahl(z, v0, v1, dt, sliding):
    for _, travel, _ in _parts(v0, v1, dt):
        z = _clamp(_slid(z, travel, sliding), -sliding, sliding)
    return z


)"},
    {"lugre", " clamp slid parts curve",
     R"(def _lugre(z, v0, v1, dt, sliding, breakaway, stribeck):
    most = max(sliding, breakaway)
    for speed, travel, _ in _parts(v0, v1, dt):
        z = _clamp(_slid(z, travel, _curve(sliding, breakaway, stribeck, speed)), -most, most)
    return z


)"},
    {"slip", " clamp parts", R"(def _slip(z, v0, v1, dt, limit):
    for _, travel, _ in _parts(v0, v1, dt):
        z = _clamp(z + travel, -limit, limit)
    return z


)"},
    {"gms", " clamp parts curve sign",
     R"(def _gms(z, slips, k, v0, v1, dt, limit, breakaway, stribeck, attraction):
    most = max(limit, breakaway)
    for speed, travel, seconds in _parts(v0, v1, dt):
        direction = _sign(travel)
        if direction == 0:
            continue
        level = _curve(limit, breakaway, stribeck, speed)
        if slips[k] and z * direction < 0:
            slips[k] = False
        if not slips[k]:
            if (z + travel) * direction < level:
                z = _clamp(z + travel, -most, most)
                continue
            slips[k] = True
            if z * direction < level:
                z = direction * level
                continue
        e = math.exp(-(seconds * limit / (level * attraction)))
        z = _clamp(e * z + direction * level * (1.0 - e), -most, most)
    return z


)"},
    {"backlash", " slip", R"(def _backlash(z, v0, v1, l0, l1, dt, half_gap, drift):
    return _slip(z, v0 + drift * l0, v1 + drift * l1, dt, half_gap)


)"},
    {"warmth", " lag", R"(def _warmth(z, v0, v1, l0, l1, dt, time_constant):
    return _lag(z, abs(v0 * l0), abs(v1 * l1), dt, time_constant)


)"},
}};

constexpr std::array<Piece, 11> kMatlab = {{
    {"clamp", "", R"(
function x = law_clamp(x, low, high)
  x = min(max(x, low), high);
end
)"},
    {"parts", "", R"(
function [speed, travel, seconds] = law_parts(v0, v1, dt)
  if (v0 < 0 && v1 > 0) || (v0 > 0 && v1 < 0)
    first = dt * (v0 / (v0 - v1));
    seconds = [first, dt - first];
    speed = 0.5 * [v0, v1];
  else
    seconds = dt;
    speed = 0.5 * (v0 + v1);
  end
  travel = speed .* seconds;
end
)"},
    {"curve", "", R"(
function g = law_curve(low, high, scale, speed)
  ratio = speed / scale;
  g = low + (high - low) * exp(-(ratio * ratio));
end
)"},
    {"slid", "", R"(
function z = law_slid(z, travel, g)
  e = exp(-(abs(travel) / g));
  z = e * z + sign(travel) * g * (1 - e);
end
)"},
    {"lag", " clamp", R"(
function z = law_lag(z, x0, x1, dt, time_constant)
  r = dt / time_constant;
  if r > 0
    e = exp(-r);
    after = x1 + e * (z - x0) - (x1 - x0) * ((1 - e) / r);
    z = law_clamp(after, min([z, x0, x1]), max([z, x0, x1]));
  end
end
)"},
    {"dahl", " clamp slid parts", R"(
function z = law_dahl(z, v0, v1, dt, sliding)
  [~, travel] = law_parts(v0, v1, dt);
  for k = 1:numel(travel)
    z = law_clamp(law_slid(z, travel(k), sliding), -sliding, sliding);
  end
end
)"},
    {"lugre", " clamp slid parts curve", R"(
function z = law_lugre(z, v0, v1, dt, sliding, breakaway, stribeck)
  most = max(sliding, breakaway);
  [speed, travel] = law_parts(v0, v1, dt);
  for k = 1:numel(travel)
    g = law_curve(sliding, breakaway, stribeck, speed(k));
    z = law_clamp(law_slid(z, travel(k), g), -most, most);
  end
end
)"},
    {"slip", " clamp parts", R"(
function z = law_slip(z, v0, v1, dt, limit)
  [~, travel] = law_parts(v0, v1, dt);
  for k = 1:numel(travel)
    z = law_clamp(z + travel(k), -limit, limit);
  end
end
)"},
    {"gms", " clamp parts curve", R"(
function [z, slips] = law_gms(z, slips, v0, v1, dt, limit, breakaway, stribeck, attraction)
  most = max(limit, breakaway);
  [speed, travel, seconds] = law_parts(v0, v1, dt);
  for k = 1:numel(travel)
    direction = sign(travel(k));
    if direction == 0
      continue
    end
    level = law_curve(limit, breakaway, stribeck, speed(k));
    if slips && z * direction < 0
      slips = 0;
    end
    if ~slips
      if (z + travel(k)) * direction < level
        z = law_clamp(z + travel(k), -most, most);
        continue
      end
      slips = 1;
      if z * direction < level
        z = direction * level;
        continue
      end
    end
    e = exp(-(seconds(k) * limit / (level * attraction)));
    z = law_clamp(e * z + direction * level * (1 - e), -most, most);
  end
end
)"},
    {"backlash", " slip", R"(
function z = law_backlash(z, v0, v1, l0, l1, dt, half_gap, drift)
  z = law_slip(z, v0 + drift * l0, v1 + drift * l1, dt, half_gap);
end
)"},
    {"warmth", " lag", R"(
function z = law_warmth(z, v0, v1, l0, l1, dt, time_constant)
  z = law_lag(z, abs(v0 * l0), abs(v1 * l1), dt, time_constant);
end
)"},
}};

// The pieces that the laws need, in the order of the table, which has what is needed first.
template <std::size_t N>
std::string needed(const std::array<Piece, N>& pieces, const std::set<StateLaw>& laws,
                   std::string_view always = {}) {
  std::set<std::string_view> wanted;
  if (!always.empty()) wanted.insert(always);
  for (const StateLaw law : laws) wanted.insert(state_law_info(law).name);
  for (std::size_t i = N; i-- > 0;) {
    if (!wanted.contains(pieces[i].name)) continue;
    std::string_view needs = pieces[i].needs;
    while (!needs.empty()) {
      needs.remove_prefix(1);
      const std::size_t end = std::min(needs.find(' '), needs.size());
      wanted.insert(needs.substr(0, end));
      needs.remove_prefix(end);
    }
  }
  std::string text;
  for (const Piece& piece : pieces) {
    if (wanted.contains(piece.name)) text += piece.text;
  }
  return text;
}

std::string filled(std::string text, const std::string& name, bool single) {
  const std::array<std::pair<std::string_view, std::string>, 3> marks = {
      {{"$N", name + "_"}, {"$R", single ? "float" : "double"}, {"$f", single ? "f" : ""}}};
  for (const auto& [mark, value] : marks) {
    for (std::size_t at = text.find(mark); at != std::string::npos;
         at = text.find(mark, at + value.size())) {
      text.replace(at, mark.size(), value);
    }
  }
  return text;
}

}  // namespace

std::string state_code_c(const std::string& name, bool single, const std::set<StateLaw>& laws) {
  std::string text = "#include <math.h>\n#include <stdint.h>\n#include <string.h>\n\n";
  text += single ? kFloatExp : kDoubleExp;
  text += needed(kC, laws, "sign");
  return filled(std::move(text), name, single);
}

std::string state_code_python(const std::set<StateLaw>& laws) {
  return needed(kPython, laws, "sign");
}

std::string state_code_matlab(const std::set<StateLaw>& laws) { return needed(kMatlab, laws); }

}  // namespace tribench
