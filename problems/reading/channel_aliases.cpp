// SPDX-License-Identifier: MIT
//
// Names of channels, as data. A unit stands here only where the source of the name always uses it;
// where it differs from log to log, it has to be in the header or said with --roles.
//
// Sources:
//   tribench   this program's own files and its documentation
//   ROS        sensor_msgs/JointState, std_msgs/Header; SI by REP 103
//   libfranka  franka::RobotState (q, dq, tau_J, tau_ext_hat_filtered): rad, rad/s, N m
//   RTDE       Universal Robots' Real-Time Data Exchange (actual_q, actual_qd, actual_current)
//   FRI, RSI   KUKA's Fast Research Interface (measured position, torque: rad, N m) and Robot
//              Sensor Interface (AIPos: deg; MACur)
//   CiA 402    drives' objects 0x6064, 0x606C, 0x6077, 0x6078: in units that each drive sets itself
//   usual      what people write; says what the channel is and not in which unit
#include <array>

#include "problems/reading/channel_names.hpp"

namespace tribench {
namespace {

constexpr std::string_view kOwn = "tribench";
constexpr std::string_view kRos = "ROS";
constexpr std::string_view kFranka = "libfranka";
constexpr std::string_view kRtde = "RTDE";
constexpr std::string_view kFri = "KUKA FRI";
constexpr std::string_view kRsi = "KUKA RSI";
constexpr std::string_view kCia402 = "CiA 402";
constexpr std::string_view kUsual = "usual";

using enum Role;

constexpr std::array kAliases = {
    ChannelAlias{"time", time, "s", kOwn},
    ChannelAlias{"t", time, "s", kOwn},
    ChannelAlias{"stamp", time, "", kRos},
    ChannelAlias{"header_stamp", time, "", kRos},
    ChannelAlias{"timestamp", time, "", kUsual},
    ChannelAlias{"time_stamp", time, "", kUsual},
    ChannelAlias{"zeit", time, "", kUsual},
    ChannelAlias{"tick", time, "", kUsual, true},
    ChannelAlias{"ticks", time, "", kUsual, true},
    ChannelAlias{"millis", time, "ms", kUsual},
    ChannelAlias{"micros", time, "us", kUsual},
    ChannelAlias{"elapsed", time, "", kUsual},
    ChannelAlias{"elapsed_time", time, "", kUsual},
    ChannelAlias{"rosbagtimestamp", time, "", kRos},
    ChannelAlias{"rosbag_timestamp", time, "", kRos},
    ChannelAlias{"sim_time", time, "", kUsual},
    ChannelAlias{"ts", time, "", kUsual},
    ChannelAlias{"clock", time, "", kUsual},
    ChannelAlias{"datetime", time, "", kUsual},
    ChannelAlias{"date_time", time, "", kUsual},
    ChannelAlias{"uhrzeit", time, "", kUsual},
    ChannelAlias{"zeitstempel", time, "", kUsual},
    ChannelAlias{"time_of_day", time, "", kUsual},
    ChannelAlias{"movement", movement, "", kOwn},
    ChannelAlias{"position", position, "rad", kRos},
    ChannelAlias{"q", position, "rad", kFranka},
    ChannelAlias{"actual_q", position, "rad", kRtde},
    ChannelAlias{"q_actual", position, "rad", kRtde},
    ChannelAlias{"measured_joint_position", position, "rad", kFri},
    ChannelAlias{"position_actual_value", position, "", kCia402},
    ChannelAlias{"aipos", position, "deg", kRsi},
    ChannelAlias{"ai_pos", position, "deg", kRsi},
    ChannelAlias{"winkel", position, "", kUsual},
    ChannelAlias{"lage", position, "", kUsual},
    ChannelAlias{"lageistwert", position, "", kUsual},
    ChannelAlias{"istposition", position, "", kUsual},
    ChannelAlias{"positionsistwert", position, "", kUsual},
    ChannelAlias{"istwinkel", position, "", kUsual},
    ChannelAlias{"istlage", position, "", kUsual},
    ChannelAlias{"ang", position, "", kUsual},
    ChannelAlias{"angular_position", position, "", kUsual},
    ChannelAlias{"pos", position, "", kUsual},
    ChannelAlias{"angle", position, "", kUsual},
    ChannelAlias{"theta", position, "", kUsual},
    ChannelAlias{"phi", position, "", kUsual},
    ChannelAlias{"encoder", position, "", kUsual},
    ChannelAlias{"enc", position, "", kUsual},
    ChannelAlias{"encoder_position", position, "", kUsual},
    ChannelAlias{"velocity", velocity, "rad/s", kRos},
    ChannelAlias{"v", velocity, "rad/s", kOwn},
    ChannelAlias{"qd", velocity, "rad/s", kOwn},
    ChannelAlias{"dq", velocity, "rad/s", kFranka},
    ChannelAlias{"qdot", velocity, "rad/s", kUsual},
    ChannelAlias{"q_dot", velocity, "rad/s", kUsual},
    ChannelAlias{"actual_qd", velocity, "rad/s", kRtde},
    ChannelAlias{"qd_actual", velocity, "rad/s", kRtde},
    ChannelAlias{"velocity_actual_value", velocity, "", kCia402},
    ChannelAlias{"geschwindigkeit", velocity, "", kUsual},
    ChannelAlias{"drehzahl", velocity, "", kUsual},
    ChannelAlias{"drehzahlistwert", velocity, "", kUsual},
    ChannelAlias{"istdrehzahl", velocity, "", kUsual},
    ChannelAlias{"istgeschwindigkeit", velocity, "", kUsual},
    ChannelAlias{"angular_velocity", velocity, "", kUsual},
    ChannelAlias{"ang_vel", velocity, "", kUsual},
    ChannelAlias{"velo", velocity, "", kUsual},
    ChannelAlias{"spd", velocity, "", kUsual},
    ChannelAlias{"vel", velocity, "", kUsual},
    ChannelAlias{"speed", velocity, "", kUsual},
    ChannelAlias{"omega", velocity, "", kUsual},
    ChannelAlias{"w", velocity, "", kUsual},
    ChannelAlias{"dtheta", velocity, "", kUsual},
    ChannelAlias{"theta_dot", velocity, "", kUsual},
    ChannelAlias{"acceleration", acceleration, "rad/s^2", kRos},
    ChannelAlias{"a", acceleration, "rad/s^2", kOwn},
    ChannelAlias{"qdd", acceleration, "rad/s^2", kOwn},
    ChannelAlias{"ddq", acceleration, "rad/s^2", kFranka},
    ChannelAlias{"qddot", acceleration, "rad/s^2", kUsual},
    ChannelAlias{"angular_acceleration", acceleration, "", kUsual},
    ChannelAlias{"beschleunigung", acceleration, "", kUsual},
    ChannelAlias{"acc", acceleration, "", kUsual},
    ChannelAlias{"accel", acceleration, "", kUsual},
    ChannelAlias{"gravity_torque", gravity_torque, "", kOwn},
    ChannelAlias{"gravity", gravity_torque, "", kOwn},
    ChannelAlias{"tau_g", gravity_torque, "N m", kOwn},
    ChannelAlias{"g", gravity_torque, "N m", kOwn},
    ChannelAlias{"tau_gravity", gravity_torque, "", kUsual},
    ChannelAlias{"tau_grav", gravity_torque, "", kUsual},
    ChannelAlias{"grav", gravity_torque, "", kUsual},
    ChannelAlias{"g_torque", gravity_torque, "", kUsual},
    ChannelAlias{"schweremoment", gravity_torque, "", kUsual},
    ChannelAlias{"schwerkraftmoment", gravity_torque, "", kUsual},
    ChannelAlias{"gravitationsmoment", gravity_torque, "", kUsual},
    ChannelAlias{"gewichtsmoment", gravity_torque, "", kUsual},
    ChannelAlias{"schwerkraft", gravity_torque, "", kUsual},
    ChannelAlias{"gravitation", gravity_torque, "", kUsual},
    ChannelAlias{"motor_torque", motor_torque, "", kOwn},
    ChannelAlias{"motor_force", motor_torque, "", kOwn},
    ChannelAlias{"tau_m", motor_torque, "N m", kOwn},
    ChannelAlias{"effort", motor_torque, "N m", kRos},
    ChannelAlias{"tau_j", motor_torque, "N m", kFranka},
    ChannelAlias{"measured_joint_torque", motor_torque, "N m", kFri},
    ChannelAlias{"torque_actual_value", motor_torque, "", kCia402},
    ChannelAlias{"tau", motor_torque, "", kUsual},
    ChannelAlias{"torque", motor_torque, "", kUsual},
    ChannelAlias{"force", motor_torque, "", kUsual},
    ChannelAlias{"drehmoment", motor_torque, "", kUsual},
    ChannelAlias{"drehmomentistwert", motor_torque, "", kUsual},
    ChannelAlias{"momentenistwert", motor_torque, "", kUsual},
    ChannelAlias{"istmoment", motor_torque, "", kUsual},
    ChannelAlias{"istdrehmoment", motor_torque, "", kUsual},
    ChannelAlias{"moment", motor_torque, "", kUsual},
    ChannelAlias{"kraft", motor_torque, "", kUsual},
    ChannelAlias{"trq", motor_torque, "", kUsual},
    ChannelAlias{"friction_torque", friction_torque, "", kOwn},
    ChannelAlias{"friction_force", friction_torque, "", kOwn},
    ChannelAlias{"friction", friction_torque, "", kOwn},
    ChannelAlias{"tau_f", friction_torque, "N m", kOwn},
    ChannelAlias{"tau_fric", friction_torque, "", kUsual},
    ChannelAlias{"tau_friction", friction_torque, "", kUsual},
    ChannelAlias{"external_torque", external_torque, "", kOwn},
    ChannelAlias{"tau_ext", external_torque, "N m", kOwn},
    ChannelAlias{"tau_ext_hat_filtered", external_torque, "N m", kFranka},
    ChannelAlias{"temperature", temperature, "", kOwn},
    ChannelAlias{"temperatur", temperature, "", kUsual},
    ChannelAlias{"motortemperatur", temperature, "", kUsual},
    ChannelAlias{"temp", temperature, "", kUsual},
    ChannelAlias{"motor_temperature", temperature, "", kUsual},
    ChannelAlias{"motor_temp", temperature, "", kUsual},
    ChannelAlias{"temp_motor", temperature, "", kUsual},
    ChannelAlias{"temperatures", temperature, "", kUsual},
    ChannelAlias{"joint_temperatures", temperature, "degC", kRtde},
    ChannelAlias{"motor_current", motor_current, "", kOwn},
    ChannelAlias{"current", motor_current, "", kOwn},
    ChannelAlias{"actual_current", motor_current, "A", kRtde},
    ChannelAlias{"current_actual_value", motor_current, "", kCia402},
    ChannelAlias{"current_motor", motor_current, "", kUsual},
    ChannelAlias{"macur", motor_current, "", kRsi},
    ChannelAlias{"strom", motor_current, "", kUsual},
    ChannelAlias{"stromistwert", motor_current, "", kUsual},
    ChannelAlias{"iststrom", motor_current, "", kUsual},
    ChannelAlias{"motorstrom", motor_current, "", kUsual},
    ChannelAlias{"cur", motor_current, "", kUsual},
    ChannelAlias{"curr", motor_current, "", kUsual},
    ChannelAlias{"i", motor_current, "", kUsual},
    ChannelAlias{"iq", motor_current, "", kUsual},
    ChannelAlias{"i_q", motor_current, "", kUsual},
    ChannelAlias{"i_m", motor_current, "", kUsual},
    ChannelAlias{"i_mot", motor_current, "", kUsual},
    ChannelAlias{"imot", motor_current, "", kUsual},
    // Letters that stand for anything, unless a unit tells.
    ChannelAlias{"p", position, "", kUsual, true},
    ChannelAlias{"x", position, "", kUsual, true},
    ChannelAlias{"n", velocity, "", kUsual, true},
    ChannelAlias{"f", motor_torque, "", kUsual, true},
    ChannelAlias{"m", motor_torque, "", kUsual, true},
    ChannelAlias{"other_velocity", other_velocity, "rad/s", kOwn},
    ChannelAlias{"v2", other_velocity, "rad/s", kOwn},
    ChannelAlias{"other_acceleration", other_acceleration, "rad/s^2", kOwn},
    ChannelAlias{"a2", other_acceleration, "rad/s^2", kOwn},
};

}  // namespace

std::span<const ChannelAlias> channel_aliases() { return kAliases; }

}  // namespace tribench
