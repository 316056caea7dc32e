// SPDX-License-Identifier: MIT
//
// What Scholl et al. 2025 print in their Tables 1 to 3: mean absolute error in N m and complexity,
// by the problem and the method that stand for it here. Complexities of Table 3 count the
// adaptation alone where there is one.
#pragma once

#include <array>
#include <string_view>

namespace tribench {

struct PaperFigure {
  int table;
  std::string_view problem;
  std::string_view method;  // symmetric, asymmetric, parfam, pysr, udsr
  double mae_nm;
  int complexity;
};

inline constexpr std::array kPaperFigures = {
    PaperFigure{1, "A/j2/no_load", "symmetric", 0.737, 20},
    PaperFigure{1, "A/j2/no_load", "asymmetric", 0.134, 40},
    PaperFigure{1, "A/j2/no_load", "parfam", 0.037, 22},
    PaperFigure{1, "A/j2/no_load", "pysr", 0.041, 15},
    PaperFigure{1, "A/j2/no_load", "udsr", 0.033, 36},
    PaperFigure{1, "A/j4/no_load", "symmetric", 0.350, 20},
    PaperFigure{1, "A/j4/no_load", "asymmetric", 0.093, 40},
    PaperFigure{1, "A/j4/no_load", "parfam", 0.058, 23},
    PaperFigure{1, "A/j4/no_load", "pysr", 0.074, 11},
    PaperFigure{1, "A/j4/no_load", "udsr", 0.059, 43},
    PaperFigure{2, "A/j2/load", "symmetric", 3.663, 20},
    PaperFigure{2, "A/j2/load", "asymmetric", 4.073, 40},
    PaperFigure{2, "A/j2/load", "parfam", 1.025, 63},
    PaperFigure{2, "A/j2/load", "pysr", 1.294, 13},
    PaperFigure{2, "A/j2/load", "udsr", 7.168, 12},
    PaperFigure{2, "A/j4/load", "symmetric", 0.914, 20},
    PaperFigure{2, "A/j4/load", "asymmetric", 1.068, 40},
    PaperFigure{2, "A/j4/load", "parfam", 0.724, 32},
    PaperFigure{2, "A/j4/load", "pysr", 0.800, 8},
    PaperFigure{2, "A/j4/load", "udsr", 2.671, 12},
    PaperFigure{3, "B/j2/no_load", "symmetric", 3.663, 20},
    PaperFigure{3, "B/j2/no_load", "asymmetric", 4.073, 40},
    PaperFigure{3, "B/j2/no_load", "parfam", 0.611, 20},
    PaperFigure{3, "B/j2/no_load", "pysr", 0.911, 3},
    PaperFigure{3, "B/j2/no_load", "udsr", 4.824, 5},
    PaperFigure{3, "B/j2/load", "symmetric", 3.171, 20},
    PaperFigure{3, "B/j2/load", "asymmetric", 3.550, 40},
    PaperFigure{3, "B/j2/load", "parfam", 1.007, 20},
    PaperFigure{3, "B/j2/load", "pysr", 0.953, 3},
    PaperFigure{3, "B/j2/load", "udsr", 4.502, 5},
    PaperFigure{3, "B/j4/no_load", "symmetric", 1.473, 20},
    PaperFigure{3, "B/j4/no_load", "asymmetric", 1.318, 40},
    PaperFigure{3, "B/j4/no_load", "parfam", 0.742, 11},
    PaperFigure{3, "B/j4/no_load", "pysr", 0.936, 2},
    PaperFigure{3, "B/j4/no_load", "udsr", 2.238, 5},
    PaperFigure{3, "B/j4/load", "symmetric", 1.628, 20},
    PaperFigure{3, "B/j4/load", "asymmetric", 1.648, 40},
    PaperFigure{3, "B/j4/load", "parfam", 1.189, 11},
    PaperFigure{3, "B/j4/load", "pysr", 1.428, 2},
    PaperFigure{3, "B/j4/load", "udsr", 1.636, 5}};

}  // namespace tribench
