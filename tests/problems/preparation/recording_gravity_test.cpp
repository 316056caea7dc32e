// SPDX-License-Identifier: MIT
//
// Declared gravity beside the torque that holds it.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "foundation/error.hpp"
#include "problems/preparation/recording.hpp"

namespace tribench {
namespace {

using ::testing::HasSubstr;

// What is said of a swinging joint whose torque holds `held` times the gravity that is declared.
std::string complaint_where_torque_holds(double held) {
  std::string text = "t,q,dq,tau,g\n";
  for (int i = 0; i < 5000; ++i) {
    const double t = 0.004 * i;
    const double q = std::sin(1.3 * t) + 0.5 * std::sin(0.31 * t);
    const double v = 1.3 * std::cos(1.3 * t) + 0.155 * std::cos(0.31 * t);
    const double gravity = 10 * std::cos(q);
    const double friction = (v > 0 ? 1 : -1) + 0.5 * v + 0.02 * std::sin(17.0 * i);
    text += fmt::format("{:.4f},{:.7f},{:.6f},{:.5f},{:.5f}\n", t, q, v, held * gravity + friction,
                        gravity);
  }
  DataOptions options;
  CsvOptions csv;
  csv.used.emplace();
  csv.roles = parse_roles(
      "t=time[s],q=position[rad],dq=velocity[rad/s],tau=motor_torque[N m],g=gravity_torque[N m]",
      "--roles");
  try {
    prepare(parse_csv(text, "log.csv", csv), options);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

// A model of gravity is off by some tenths, and a payload adds to it; neither turns its sign.
TEST(RecordingGravity, ATurnedSignIsRefusedHoweverGoodTheModel) {
  for (const double held : {0.7, 1.0, 1.6}) {
    EXPECT_EQ(complaint_where_torque_holds(held), "no error") << held;
    EXPECT_THAT(complaint_where_torque_holds(-held), HasSubstr("has its sign turned")) << held;
  }
}

}  // namespace
}  // namespace tribench
