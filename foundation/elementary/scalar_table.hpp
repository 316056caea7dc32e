// SPDX-License-Identifier: MIT
//
// The table of scalar.hpp from the vector functions: every lane computes the same.
#pragma once

#include "foundation/elementary/power.hpp"
#include "foundation/elementary/scalar.hpp"

namespace tribench {
namespace {

constexpr elementary::ScalarTable kScalarTable = {
    [](double x) { return exp(splat(x))[0]; },
    [](double x) { return log(splat(x))[0]; },
    [](double x) { return sin(splat(x))[0]; },
    [](double x) { return cos(splat(x))[0]; },
    [](double x) { return tanh(splat(x))[0]; },
    [](double x) { return atan(splat(x))[0]; },
    [](double x, double y) { return pow(splat(x), splat(y))[0]; },
};

}  // namespace
}  // namespace tribench
