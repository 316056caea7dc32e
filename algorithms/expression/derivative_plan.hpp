// SPDX-License-Identifier: MIT
//
// A tape made ready for derivatives: what is one number and what a column, which places the wanted
// derivatives pass, and where in a workspace each column lies. Internal to the room.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "algorithms/expression/expression.hpp"

namespace tribench {

class DerivativePlan {
 public:
  enum class Kind : std::uint8_t { scalar, column };
  // A place of the tape. A subtree of constants alone is a scalar, all else a column; the slots
  // are the columns of the workspace that hold its values and its adjoint.
  struct Step {
    Op op = Op::constant;
    Kind kind = Kind::scalar;
    bool wanted = false;       // a parameter lies in the subtree
    bool whole_power = false;  // ^ with a constant whole exponent
    int exponent = 0;
    std::uint32_t a = 0;  // places of the children; of a variable, the input
    std::uint32_t b = 0;
    std::uint32_t value_slot = 0;
    std::uint32_t adjoint_slot = 0;
  };
  struct Leaf {
    std::uint32_t place;
    std::uint32_t parameter;
  };

  // With respect to the constants at these places of the tape, each named once.
  void prepare(const Expression& formula, std::span<const std::size_t> constants);
  // With respect to inputs 0 .. inputs - 1.
  void prepare_for_inputs(const Expression& formula, std::size_t inputs);
  // New values of the constants named in `prepare`, in that order.
  void set_constants(std::span<const double> values);
  // The values of all scalars from those of the constants.
  void compute_scalars();

  std::size_t parameters() const { return parameter_count_; }
  std::size_t slots() const { return slot_count_; }
  std::span<const Step> steps() const { return steps_; }
  std::span<const Leaf> leaves() const { return leaves_; }
  std::size_t root() const { return steps_.size() - 1; }
  bool is_scalar(std::size_t place) const { return steps_[place].kind == Kind::scalar; }
  const double& scalar(std::size_t place) const { return scalars_[place]; }

 private:
  void compile(const Expression& formula);
  void assign_slots();

  std::vector<Step> steps_;
  std::vector<double> scalars_;  // per place: the value of a scalar
  std::vector<Leaf> leaves_;
  std::vector<std::uint32_t> stack_;
  std::size_t slot_count_ = 0;
  std::size_t parameter_count_ = 0;
};

}  // namespace tribench
