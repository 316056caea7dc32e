// SPDX-License-Identifier: MIT
//
// The pictures of a run's page as SVG files, for papers and READMEs: the same specifications from
// the same data, drawn by the same Vega, run in node (the distribution's nodejs) instead of a
// browser. Text is measured by rule there, not by fonts: labels may stand a pixel or two elsewhere.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tribench {

// Reads the run and writes PROBLEM.OPERATORS.PICTURE.svg for front, friction, error, profile,
// trace_evaluations, trace_cpu and singular, and all.OPERATORS.PICTURE.svg for heat, ranks,
// profiles and ecdf, where there is something to draw. Returns the files' names. Throws Error
// (failed) where there is no node, naming the package.
// only: names of the files wanted; empty: all.
std::vector<std::string> write_pictures(const std::filesystem::path& run,
                                        const std::filesystem::path& out,
                                        const std::vector<std::string>& only = {});

// The name of a picture's file; of all problems together with `problem` "all".
std::string picture_file(std::string_view problem, std::string_view operators,
                         std::string_view picture);

}  // namespace tribench
