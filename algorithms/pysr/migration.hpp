// SPDX-License-Identifier: MIT
//
// Copies of good members travel into an island. Nothing is fitted or scored anew: what they cost is
// as their own island knew it.
#pragma once

#include <span>
#include <vector>

#include "algorithms/pysr/member.hpp"
#include "foundation/random.hpp"

namespace tribench::pysr {

// The `count` members of lowest cost, best first.
std::vector<Member> best_members(std::span<const Member> members, int count);

// Draws n from a Poisson law of mean size * fraction (at most the size) and overwrites n uniformly
// drawn places (with repetition) by copies of uniformly drawn migrants, born now. `clock` is the
// island's. Returns n. Nothing happens without migrants.
// Source: SymbolicRegression.jl, Migration.jl.
std::size_t migrate(std::span<const Member> migrants, std::span<Member> members, double fraction,
                    std::uint64_t& clock, RandomStream& random);

}  // namespace tribench::pysr
