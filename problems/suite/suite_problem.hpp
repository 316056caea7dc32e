// SPDX-License-Identifier: MIT
//
// A suite's problems in the catalogue, as SUITE/PROBLEM. Not for reading its file (suite.hpp), and
// not for laws with units or movements: rows are drawn one by one.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "problems/problem.hpp"
#include "problems/suite/suite.hpp"

namespace tribench::suite {

// A law as a function of a point (its inputs in order). Formulas live above this room: whoever can
// read them hands the reader in.
using Law = std::function<double(std::span<const double> point)>;
using LawReader =
    std::function<Law(const std::string& formula, std::span<const std::string> names)>;

// The law of a problem that draws its points. Throws Error (bad_input) with its place in the file.
Law read_law_of(const SuiteProblem& wanted, const LawReader& laws);

// The seed draws the points (of a table: the rows for the test). Points at which the law is not
// finite are drawn again. The input box is that of the draws, of a table that of the training rows.
// Throws Error (bad_input) where a table is not in the folder, and where no finite point is found.
Problem make_suite_problem(const Suite& suite, const SuiteProblem& wanted, const LawReader& laws,
                           const std::optional<std::filesystem::path>& data, std::uint64_t seed);

// The shipped suites, and those of <data>/suites/*.toml in the order of their names; one of these
// with a shipped one's name takes its place; with what is published beside them, where the folder
// has it. Throws Error (bad_input) where one cannot be read.
std::vector<Suite> known_suites(const std::optional<std::filesystem::path>& data);

void add_entries(std::vector<ProblemEntry>& entries, const Suite& suite, const LawReader& laws,
                 const std::optional<std::filesystem::path>& data);

}  // namespace tribench::suite
