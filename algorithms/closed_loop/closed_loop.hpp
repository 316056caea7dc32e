// SPDX-License-Identifier: MIT
//
// The closed loop as an algorithm like the others: fits its base, adds the effects that the data
// ask for and returns the whole as one formula. Its base is Coulomb and viscous friction by
// direction, any method of the registry, or a formula.
//
// The front is the base alone and, where something was added, the base with its effects. Effects
// that need a channel the problem does not have are left out.
#pragma once

#include <memory>
#include <string>

#include "algorithms/diagnosis/diagnosis.hpp"
#include "algorithms/regressor.hpp"

namespace tribench {
AlgorithmEntry closed_loop_entry();
}

namespace tribench::loop {

// A base that a method fits to the training movements: over velocity, load and what is rigid.
// method and budget must outlive the maker. Throws Error (bad_input) where the method gives
// nothing.
BaseMaker method_base(const Regressor& method, std::string name, RandomStream random,
                      Budget& budget);

}  // namespace tribench::loop
