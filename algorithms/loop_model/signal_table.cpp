// SPDX-License-Identifier: MIT
#include "algorithms/loop_model/signal_table.hpp"

#include "algorithms/regressor.hpp"
#include "problems/preparation/observation_rows.hpp"

namespace tribench::loop {

SignalTable::SignalTable(const Observations& data) : rows_(data.rows()) {
  for (const Signal& signal : data.signals) pointers_.push_back(signal.values.data());
}

Observations observe(const TrainingData& data) {
  Observations out;
  out.target.assign(data.target.begin(), data.target.end());
  out.target_name = "target";
  out.movement.assign(data.movement.begin(), data.movement.end());
  if (out.movement.empty()) out.movement.assign(out.target.size(), 0);
  for (std::size_t j = 0; j < data.inputs.size(); ++j) {
    const Input& input = data.inputs[j];
    const std::string name = signal_name(input.role, input.name);
    if (out.find(name) != nullptr) continue;
    out.signals.push_back({name,
                           input.name,
                           input.unit,
                           input.role,
                           {},
                           {data.columns[j], data.columns[j] + data.rows()}});
  }
  complete_signals(out);
  for (std::size_t i = 0; i < out.rows(); ++i) out.time.push_back(static_cast<double>(i));
  drop_constant_signals(out);
  return out;
}

}  // namespace tribench::loop
