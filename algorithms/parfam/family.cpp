// SPDX-License-Identifier: MIT
#include "algorithms/parfam/family.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <sstream>
#include <tuple>
#include <utility>

#include "foundation/error.hpp"

namespace tribench::parfam {
namespace {

// In the order of what they cost to compute and to read.
constexpr Op kBaseFunctions[] = {Op::exp, Op::sqrt, Op::tanh, Op::cos, Op::sin, Op::log};

// All multisets of `size` base functions, in the order of the list.
void multisets(const std::vector<Op>& base, std::size_t from, int size, std::vector<Op>& current,
               std::vector<std::vector<Op>>& result) {
  if (size == 0) {
    result.push_back(current);
    return;
  }
  for (std::size_t i = from; i < base.size(); ++i) {
    current.push_back(base[i]);
    multisets(base, i, size - 1, current, result);
    current.pop_back();
  }
}

[[noreturn]] void refuse_family(const std::string& text) {
  throw_bad_input(fmt::format("'{}' is no family of ParFam", text), {},
                  "write the output's degrees, the functions and their arguments' degrees, as in "
                  "'2/0 exp 2/0', or the output's alone, as in '3/1'");
}

// "2/1": the degrees of a ratio.
std::pair<int, int> parse_degrees(const std::string& part, const std::string& text) {
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  if (part.size() != 3 || !digit(part[0]) || part[1] != '/' || !digit(part[2])) {
    refuse_family(text);
  }
  return {part[0] - '0', part[2] - '0'};
}

}  // namespace

Family parse_family(const std::string& text) {
  std::istringstream parts(text);
  std::string out;
  std::string functions;
  std::string in;
  std::string more;
  parts >> out >> functions >> in >> more;
  if (functions.empty() != in.empty() || !more.empty()) refuse_family(text);
  Family family;
  std::tie(family.degree_out, family.degree_out_denominator) = parse_degrees(out, text);
  if (functions.empty()) return family;
  std::tie(family.degree_in, family.degree_in_denominator) = parse_degrees(in, text);
  std::istringstream names(functions);
  for (std::string name; std::getline(names, name, ',');) {
    const auto found = std::ranges::find(kBaseFunctions, name, op_name);
    if (found == std::end(kBaseFunctions)) refuse_family(text);
    family.functions.push_back(*found);
  }
  return family;
}

bool is_within(const Family& family, const OperatorSet& operators) {
  const bool divides = family.degree_in_denominator + family.degree_out_denominator > 0;
  return (!divides || operators.allows(Op::div)) &&
         std::ranges::all_of(family.functions, [&](Op op) { return operators.allows(op); });
}

std::string describe(const Family& family) {
  if (family.functions.empty()) {
    return family.degree_out_denominator == 0
               ? fmt::format("polynomial of degree {}", family.degree_out)
               : fmt::format("rational function of degrees {}/{}", family.degree_out,
                             family.degree_out_denominator);
  }
  std::string names;
  for (Op op : family.functions) {
    names += (names.empty() ? "" : ", ") + std::string(op_name(op));
  }
  return fmt::format("{} of degrees {}/{} in degrees {}/{}", names, family.degree_in,
                     family.degree_in_denominator, family.degree_out,
                     family.degree_out_denominator);
}

GridLimits small_grid() { return {}; }

GridLimits big_grid() { return {2, 2, 4, 3, 1, {Op::sqrt, Op::cos, Op::exp}, true}; }

std::vector<Family> published_grid(const GridLimits& limits) {
  std::vector<Family> grid;
  grid.push_back({0, 0, limits.degree_out, 0, {}, false});
  for (int den = 1; den <= limits.degree_out_denominator; ++den) {
    for (int num = 1; num <= limits.degree_out; ++num) grid.push_back({0, 0, num, den, {}, false});
  }
  for (int count = 1; count <= limits.functions; ++count) {
    std::vector<std::vector<Op>> choices;
    std::vector<Op> current;
    multisets(limits.base_functions, 0, count, current, choices);
    for (int out_den = 0; out_den <= limits.degree_out_denominator; ++out_den) {
      for (int out = 1; out <= limits.degree_out; ++out) {
        for (int in_den = 0; in_den <= limits.degree_in_denominator; ++in_den) {
          for (int in = 1; in <= limits.degree_in; ++in) {
            for (const auto& functions : choices) {
              for (int enforce = 0; enforce <= (limits.both_enforce ? 1 : 0); ++enforce) {
                grid.push_back({in, in_den, out, out_den, functions, enforce != 0});
              }
            }
          }
        }
      }
    }
  }
  return grid;
}

std::size_t Structure::inner_parameters() const {
  std::size_t count = 0;
  for (const auto& list : numerators) count += list.size();
  for (const auto& list : denominators) count += list.size();
  return count;
}

double parameter_count(const Family& family, std::span<const int> caps) {
  const auto denominator = [](int degree, std::span<const int> with_caps) {
    return degree == 0 ? 0 : monomial_count(degree, with_caps);
  };
  std::vector<int> out_caps(caps.begin(), caps.end());
  out_caps.resize(caps.size() + family.functions.size(), 1);
  double count = monomial_count(family.degree_out, out_caps) +
                 denominator(family.degree_out_denominator, out_caps);
  if (family.enforce_function && !family.functions.empty()) {
    count -= monomial_count(family.degree_out, caps);
  }
  if (family.functions.empty()) return count;
  return count + static_cast<double>(family.functions.size()) *
                     (monomial_count(family.degree_in, caps) +
                      denominator(family.degree_in_denominator, caps));
}

Structure make_structure(const Family& family, std::span<const int> caps) {
  Structure structure;
  structure.inputs = caps.size();
  structure.functions = family.functions;
  const auto denominator = [](int degree, std::span<const int> with_caps) {
    return degree == 0 ? std::vector<Monomial>() : monomials_up_to(degree, with_caps);
  };
  std::vector<int> out_caps(caps.begin(), caps.end());
  for (std::size_t i = 0; i < family.functions.size(); ++i) {
    structure.numerators.push_back(monomials_up_to(family.degree_in, caps));
    structure.denominators.push_back(denominator(family.degree_in_denominator, caps));
    out_caps.push_back(1);
  }
  structure.out_numerator = monomials_up_to(family.degree_out, out_caps);
  structure.out_denominator = denominator(family.degree_out_denominator, out_caps);
  if (family.enforce_function && !family.functions.empty()) {
    std::erase_if(structure.out_numerator, [&](const Monomial& monomial) {
      return std::all_of(monomial.begin() + static_cast<std::ptrdiff_t>(caps.size()),
                         monomial.end(), [](int e) { return e == 0; });
    });
  }
  return structure;
}

}  // namespace tribench::parfam
