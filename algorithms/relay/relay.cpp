// SPDX-License-Identifier: MIT
#include "algorithms/relay/relay.hpp"

#include <fmt/format.h>

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/finite_rows.hpp"
#include "algorithms/fitting/joint_front.hpp"

namespace tribench {
namespace {

// In the order in which they run: where time is short, the one that finds most alone comes first.
constexpr std::array kMembers = {"pysr", "udsr", "parfam"};

class Relay : public Regressor {
 public:
  Relay(int round, const MakeMethod& other) {
    for (const char* name : kMembers) members_.push_back({name, other(name, round)});
  }

  FitResult fit(FitContext& context) const override {
    const FiniteRows rows(context.data);
    if (rows.rows() == 0) return FitResult::unsupported("no row has a finite target and inputs");
    JointFront joint(rows.table(), rows.target);
    std::string note;
    for (std::size_t k = 0; k < members_.size(); ++k) {
      // The first runs whatever is left; the others where there is something to spend, and to find.
      if (k > 0 && (joint.is_explained() || context.budget.remaining() == 0 ||
                    context.budget.out_of_time())) {
        break;
      }
      Budget part = context.budget.share(context.budget.remaining() / (members_.size() - k));
      FitContext turn{
          context.data,    context.operators, part, context.random.split(members_[k].name),
          context.threads, context.progress};
      const FitResult result = members_[k].method->fit(turn);
      context.budget.settle(part);
      if (result.front.empty()) {
        note += fmt::format("{}{}: {}", note.empty() ? "" : "; ", members_[k].name, result.note);
        continue;
      }
      joint.add(result.front, result.chosen);
    }
    if (joint.formulas().empty()) return FitResult::unsupported(std::move(note));
    return {joint.formulas(), joint.chosen(),
            context.budget.exhausted() ? StopReason::budget : StopReason::converged,
            std::move(note)};
  }

 private:
  struct Member {
    std::string name;
    std::unique_ptr<Regressor> method;
  };
  std::vector<Member> members_;
};

}  // namespace

AlgorithmEntry relay_entry() {
  AlgorithmEntry entry;
  entry.name = "relay";
  entry.summary = "pysr, udsr and parfam one after the other, their formulas on one front";
  entry.parameters = {
      {"round", "how wide the members search: 0 as by themselves", std::int64_t{0}, 0, 1000}};
  entry.make = [](const Parameters& parameters,
                  const MakeMethod& other) -> std::unique_ptr<Regressor> {
    return std::make_unique<Relay>(static_cast<int>(parameters.integer("round")), other);
  };
  entry.widened = [](int round) {
    return std::map<std::string, ParameterValue>{{"round", std::int64_t{round}}};
  };
  return entry;
}

}  // namespace tribench
