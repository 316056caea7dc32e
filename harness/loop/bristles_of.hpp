// SPDX-License-Identifier: MIT
//
// Presliding that a diagnosis found, as bristles with a stiffness (algorithms/loop_model/bristles).
#pragma once

#include <optional>

#include "algorithms/diagnosis/diagnosis.hpp"
#include "algorithms/loop_model/bristles.hpp"

namespace tribench::loop {

// Fitted to the rows that the diagnosis was fitted to, its held-out movements not looked at. Empty
// where none was found or where fit_bristles has no answer. data: what was diagnosed.
std::optional<Bristles> bristles_of(const Diagnosis& diagnosis, const Observations& data);

}  // namespace tribench::loop
