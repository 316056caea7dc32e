// SPDX-License-Identifier: MIT
//
// An arm's URDF file either is refused with a place, or gives the gravity torque as finite numbers.
#include <cmath>

#include "problems/preparation/chain_gravity.hpp"
#include "tests/fuzz/fuzz_target.hpp"

#ifdef TRIBENCH_LIBFUZZER
// The library's links hold each other where a file makes them a circle, and are never freed.
extern "C" const char* __lsan_default_suppressions() { return "leak:urdf::parseURDF\n"; }
#endif

TRIBENCH_FUZZ_TARGET(urdf) {
  using namespace tribench;
  if (!has_chain_gravity()) return;
  const fuzz::MemoryFile file(input);
  const std::vector<std::string> names[] = {{"1"}, {"1", "2"}, {"elbow", "shoulder"}};
  for (const std::vector<std::string>& joints : names) {
    DataFile data;
    data.joint = joints.front();
    data.joints_have_words = joints.front() == "elbow";
    for (const std::string& joint : joints) {
      data.data.channels.push_back({"q " + joint, "rad", Role::position, {-1, 0, 0.5}});
      data.joint_positions.push_back({joint, "q " + joint});
    }
    data.data.movement = {0, 0, 0};
    data.data.movement_names = {"a"};
    if (!fuzz::reads([&] { add_chain_gravity(data, file.path()); })) continue;
    for (const double torque : data.data.find(Role::gravity_torque)->values) {
      fuzz::expect(std::isfinite(torque), "a torque is not finite");
    }
  }
}
