// SPDX-License-Identifier: MIT
//
// The gravity torque of one joint of an arm, from the arm's URDF file and the positions of all of
// its joints. Reading URDF is urdfdom's, the recursion (Newton, Euler over the whole tree, fixed
// links included) KDL's; both are optional at build time (Debian: liburdfdom-dev,
// liborocos-kdl-dev).
//
// Not for an arm that is not mounted upright: gravity points along -z of the file's root link.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "problems/reading/csv.hpp"

namespace tribench {

// Whether this program was built with both libraries.
bool has_chain_gravity();

// Adds the channel "urdf_gravity" (N m or N, role gravity_torque) for the joint that was chosen
// with
// --joint: what its motor must give to hold the arm. The joints of the file, in the order of their
// numbers, are the movable joints of the URDF from the root on; joints that have words are those
// whose names hold the word ("elbow" of "elbow_joint"), or the other way round, and may be more
// than the URDF's. Says so in the file's warnings.
// Throws Error (bad_input): this program is built without it, the URDF cannot be read, the numbers
// of joints differ, a movable joint has no position or several, no joint is chosen, a column
// declares gravity already.
// Cost: about 3 us a row and joint.
void add_chain_gravity(DataFile& file, const std::filesystem::path& urdf);

}  // namespace tribench
