// SPDX-License-Identifier: MIT
//
// `pysr`: regularised evolution on islands (Cranmer 2023, "Interpretable machine learning for
// science with PySR and SymbolicRegression.jl"), natively. See README.md.
#pragma once

#include "algorithms/regressor.hpp"

namespace tribench {

AlgorithmEntry pysr_entry();

}  // namespace tribench
