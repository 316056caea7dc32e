// SPDX-License-Identifier: MIT
#include "algorithms/diagnosis/loop_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "algorithms/diagnosis/loop_json.hpp"
#include "algorithms/diagnosis/smoothers.hpp"

namespace tribench::loop {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostRows = 1500;
// Four digits are more than a picture shows.
constexpr double kDigits = 1e4;

double rounded(double value, double scale) {
  return scale > 0 ? std::round(value / scale * kDigits) / kDigits * scale : value;
}

Json values_of(const Eigen::VectorXd& values, const std::vector<std::size_t>& rows) {
  const double scale = values.size() > 0 ? values.cwiseAbs().maxCoeff() : 0;
  Json array = Json::array();
  for (const std::size_t row : rows) {
    const double value = values[static_cast<Eigen::Index>(row)];
    array.push_back(std::isfinite(value) ? Json(rounded(value, scale)) : Json());
  }
  return array;
}

Eigen::VectorXd contribution(const Diagnosis& diagnosis, const Observations& data,
                             const std::string& family) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(data.rows()));
  const LoopModel& model = diagnosis.after;
  for (std::size_t k = 0; k < model.atoms.size(); ++k) {
    const Atom& atom = model.atoms[k];
    if (diagnosis.families[atom.family].name != family) continue;
    sum += evaluate_columns(atom.columns, data) *
           model.coefficients.segment(static_cast<Eigen::Index>(model.first_column(k)),
                                      static_cast<Eigen::Index>(atom.columns.size()));
  }
  return sum;
}

bool worth_a_look(const Signal& signal) {
  return !signal.name.starts_with("sgn_") && signal.name != "a2";
}

// The signals worth a look: those in which the effects and what is left over live come first.
std::vector<std::size_t> in_order(const Diagnosis& diagnosis, const Observations& data) {
  std::vector<std::size_t> order;
  const auto add = [&](std::size_t j) {
    if (worth_a_look(data.signals[j]) && std::ranges::count(order, j) == 0) order.push_back(j);
  };
  for (const Atom& atom : diagnosis.after.atoms) {
    for (const Expression& column : atom.columns) {
      for (const Node& node : column.nodes()) {
        if (node.is_variable()) add(node.variable);
      }
    }
  }
  for (const std::string& name : diagnosis.leftover.signals) {
    if (const Signal* left = data.find(name)) {
      add(static_cast<std::size_t>(left - data.signals.data()));
    }
  }
  for (std::size_t j = 0; j < data.signals.size(); ++j) add(j);
  return order;
}

// `effect` is what the refitted model says beyond the base as it was: it lies in the residual
// before where it explains it. `effects` hold each effect's own term.
Json residuals_json(const Diagnosis& diagnosis, const Observations& data) {
  std::vector<std::size_t> rows;
  const std::size_t step = (data.rows() + kMostRows - 1) / kMostRows;
  for (std::size_t i = 0; i < data.rows(); i += step) {
    const bool event = i < diagnosis.masked.size() && diagnosis.masked[i] != 0;
    if (!event) rows.push_back(i);
  }
  const Eigen::VectorXd before = target_vector(data) - predict(diagnosis.before, data);
  const Eigen::VectorXd after = target_vector(data) - predict(diagnosis.after, data);
  const Eigen::VectorXd effect = before - after;
  Json effects = Json::array();
  for (const EffectFinding& finding : diagnosis.effects) {
    const Eigen::VectorXd one = contribution(diagnosis, data, finding.family);
    effects.push_back({{"family", finding.family}, {"y", values_of(one, rows)}});
  }
  Json all = Json::array();
  for (const std::size_t j : in_order(diagnosis, data)) {
    const Signal& signal = data.signals[j];
    const Eigen::Map<const Eigen::VectorXd> x(signal.values.data(), before.size());
    all.push_back({{"channel", input_name(data, signal.name)},
                   {"unit", signal.unit},
                   {"x", values_of(x, rows)},
                   {"before", values_of(before, rows)},
                   {"after", values_of(after, rows)},
                   {"effect", values_of(effect, rows)},
                   {"effects", effects}});
  }
  return all;
}

// Where every movement (or piece of the one movement) was left out in turn, its error then.
Json left_out_json(const Diagnosis& diagnosis, const Observations& data) {
  const bool pieces = data.movements().size() == 1;
  Json all = Json::array();
  for (const MovementError& one : diagnosis.error.movements) {
    const std::string name = pieces ? fmt::format("piece {}", one.movement + 1)
                                    : data.movement_names[static_cast<std::size_t>(one.movement)];
    all.push_back(
        {{"name", name}, {"test", true}, {"mae_before", one.before}, {"mae_after", one.after}});
  }
  return all;
}

Json movements_json(const Diagnosis& diagnosis, const Observations& data) {
  if (diagnosis.test_movements.empty() && !diagnosis.error.movements.empty()) {
    return left_out_json(diagnosis, data);
  }
  const Eigen::VectorXd before = (target_vector(data) - predict(diagnosis.before, data)).cwiseAbs();
  const Eigen::VectorXd after = (target_vector(data) - predict(diagnosis.after, data)).cwiseAbs();
  Json all = Json::array();
  for (std::size_t i = 0; i < data.rows();) {
    const int movement = data.movement[i];
    std::size_t end = i;
    while (end < data.rows() && data.movement[end] == movement) ++end;
    const auto begin = static_cast<Eigen::Index>(i);
    const auto size = static_cast<Eigen::Index>(end - i);
    all.push_back({{"name", data.movement_names[static_cast<std::size_t>(movement)]},
                   {"test", std::ranges::binary_search(diagnosis.test_movements, movement)},
                   {"mae_before", before.segment(begin, size).mean()},
                   {"mae_after", after.segment(begin, size).mean()}});
    i = end;
  }
  return all;
}

Json alias_map_json(const AliasMap& map) {
  Json correlation = Json::array();
  for (Eigen::Index i = 0; i < map.correlation.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < map.correlation.cols(); ++j) {
      row.push_back(rounded(map.correlation(i, j), 1));
    }
    correlation.push_back(std::move(row));
  }
  return {{"families", map.families}, {"correlation", correlation}};
}

}  // namespace

Json loop_pictures(const Diagnosis& diagnosis, const Observations& data) {
  Json pictures;
  pictures["target"] = data.target_name;
  pictures["unit"] = data.target_unit;
  pictures["base_formula"] = formula_text(diagnosis.before, data);
  pictures["residuals"] = residuals_json(diagnosis, data);
  pictures["movements"] = movements_json(diagnosis, data);
  pictures["alias_map"] = alias_map_json(diagnosis.alias_map);
  return pictures;
}

}  // namespace tribench::loop
