// SPDX-License-Identifier: MIT
#include "algorithms/exploration/explanations.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "algorithms/diagnosis/smoothers.hpp"
#include "algorithms/effects/effect_library.hpp"
#include "algorithms/exploration/foresight.hpp"

namespace tribench::loop {
namespace {

// More columns than this are not tried as one block: most would be there for nothing.
constexpr std::size_t kWholeFamily = 10;
constexpr double kExpected = 1.5;          // root mean square of an effect, in the noise's
constexpr double kExplainedByBase = 1e-4;  // of a column's squares, on the reference

// Atoms of one template: a curve whose shape parameter lies between grid points is nearly a sum of
// its neighbours.
struct Template {
  ColumnBlock columns;
  bool beside = false;
};

std::vector<Template> templates_of(const std::vector<Atom>& atoms,
                                   std::vector<Expression>& formulas) {
  std::vector<Template> all;
  std::map<std::string, std::size_t> place;
  for (const Atom& atom : atoms) {
    // Gear ratios exclude one another: each is a template of its own.
    std::string key = atom.label;
    for (const Shape& shape : atom.shapes) {
      if (shape.name == "N") key += fmt::format(" N={}", shape.value);
    }
    const auto [found, is_new] = place.try_emplace(key, all.size());
    if (is_new) all.push_back({{}, atom.beside_another});
    for (const Expression& column : atom.columns) {
      all[found->second].columns.push_back(static_cast<Eigen::Index>(formulas.size()));
      formulas.push_back(column);
    }
  }
  return all;
}

ColumnBlock merged(const ColumnBlock& first, const ColumnBlock& second) {
  ColumnBlock out = first;
  out.insert(out.end(), second.begin(), second.end());
  return out;
}

std::vector<ColumnBlock> blocks_of(const std::vector<Template>& templates) {
  std::vector<ColumnBlock> blocks;
  ColumnBlock whole;
  for (const Template& main : templates) {
    if (main.beside) continue;
    blocks.push_back(main.columns);
    whole = merged(whole, main.columns);
    for (const Template& beside : templates) {
      if (beside.beside) blocks.push_back(merged(main.columns, beside.columns));
    }
  }
  const bool several = !blocks.empty() && whole.size() > blocks.front().size();
  if (several && whole.size() <= kWholeFamily) blocks.push_back(whole);
  return blocks;
}

}  // namespace

ExplanationSpace::ExplanationSpace(const Observations& reference,
                                   const std::vector<double>& gear_ratios)
    : reference_(reference) {
  add_library(gear_ratios);
  add_smoothers();
  scale_.setOnes(static_cast<Eigen::Index>(formulas_.size()));
  for (const Eigen::Index size : smoother_sizes_) {
    scale_.conservativeResize(scale_.size() + size);
  }
  const Eigen::MatrixXd all = raw_columns(reference_);
  const Eigen::MatrixXd base = base_columns(reference_);
  const EvidenceTable table(base, all, target_vector(reference_));
  const auto rows = static_cast<double>(reference_.rows());
  std::vector<char> dead(static_cast<std::size_t>(all.cols()), 0);
  for (Eigen::Index j = 0; j < all.cols(); ++j) {
    const double squares = all.col(j).squaredNorm();
    const bool vanishes = !(table.left_by_base(j) > kExplainedByBase * squares);
    dead[static_cast<std::size_t>(j)] = vanishes || !std::isfinite(squares) ? 1 : 0;
    scale_[j] = dead[static_cast<std::size_t>(j)] != 0 ? 0 : kExpected / std::sqrt(squares / rows);
  }
  for (ExplainingFamily& family : families_) {
    for (ColumnBlock& block : family.blocks) {
      std::erase_if(block, [&](Eigen::Index j) { return dead[static_cast<std::size_t>(j)] != 0; });
    }
    std::erase_if(family.blocks, [](const ColumnBlock& block) { return block.empty(); });
    std::ranges::sort(family.blocks);
    family.blocks.erase(std::ranges::unique(family.blocks).begin(), family.blocks.end());
    if (family.blocks.empty()) untestable_.push_back(family.name);
  }
  std::erase_if(families_, [](const ExplainingFamily& family) { return family.blocks.empty(); });
}

void ExplanationSpace::add_library(const std::vector<double>& gear_ratios) {
  const std::vector<EffectFamily>& library = builtin_effects();
  for (std::size_t f = 0; f < library.size(); ++f) {
    std::vector<std::string> missing;
    const std::vector<Atom> atoms =
        instantiate(library[f], f, reference_, gear_ratios_for(reference_, gear_ratios), missing);
    if (atoms.empty()) {
      untestable_.push_back(library[f].name);
      continue;
    }
    const std::size_t first = formulas_.size();
    ExplainingFamily family{library[f].name, false, {}, blocks_of(templates_of(atoms, formulas_))};
    for (std::size_t k = first; k < formulas_.size(); ++k) add_inputs(formulas_[k], family.inputs);
    families_.push_back(std::move(family));
  }
}

// What remembers the motion lives in all of it: a misfit of presliding shows as Stribeck.
void ExplanationSpace::add_inputs(const Expression& formula,
                                  std::vector<std::string>& inputs) const {
  const auto add = [&](std::string_view signal) {
    const std::string name = input_name(reference_, signal);
    if (std::ranges::count(inputs, name) == 0) inputs.push_back(name);
  };
  for (const Node& node : formula.nodes()) {
    if (!node.is_variable()) continue;
    const Signal& signal = reference_.signals[node.variable];
    if (signal.role == Role::velocity_sign) continue;
    if (signal.has_memory()) {
      for (const char* name : {"v", "a", "d"}) add(name);
    } else {
      add(signal.role == Role::gravity_sign ? "g" : signal.name);
    }
  }
}

void ExplanationSpace::add_smoothers() {
  auto next = static_cast<Eigen::Index>(formulas_.size());
  const bool directed = direction_of(reference_).size() > 0;
  for (const Smoother& smoother : make_smoothers(reference_, RandomStream(1))) {
    const Eigen::Index size =
        smoother.features.cols() * (directed && smoother.signals.size() == 1 ? 2 : 1);
    ExplainingFamily family{
        fmt::format("unknown:{}", fmt::join(smoother.inputs, " x ")), true, smoother.inputs, {}};
    ColumnBlock whole;
    for (Eigen::Index j = 0; j < size; ++j) {
      whole.push_back(next + j);
      // One radial function alone: something narrow.
      if (smoother.signals.size() == 1) family.blocks.push_back({next + j});
    }
    family.blocks.push_back(whole);
    families_.push_back(std::move(family));
    smoother_sizes_.push_back(size);
    next += size;
  }
}

Eigen::MatrixXd ExplanationSpace::raw_columns(const Observations& rows) const {
  const auto count = static_cast<Eigen::Index>(rows.rows());
  Eigen::MatrixXd out(count, scale_.size());
  auto next = static_cast<Eigen::Index>(formulas_.size());
  out.leftCols(next) = evaluate_columns(formulas_, rows);
  // The smoothers' intervals are those of the reference and the rows.
  const std::array<const Observations*, 2> parts = {&reference_, &rows};
  const bool same = &rows == &reference_;
  const Observations both = same ? Observations() : joined(parts);
  const Observations& all = same ? reference_ : both;
  for (const Smoother& smoother : make_smoothers(all, RandomStream(1))) {
    const Eigen::MatrixXd features = smoother.signals.size() == 1
                                         ? with_direction(smoother, all)
                                         : Eigen::MatrixXd(smoother.features.cast<double>());
    out.middleCols(next, features.cols()) = features.bottomRows(count);
    next += features.cols();
  }
  return out;
}

Eigen::MatrixXd ExplanationSpace::columns(const Observations& rows) const {
  return raw_columns(rows) * scale_.asDiagonal();
}

Eigen::MatrixXd ExplanationSpace::base_columns(const Observations& rows) const {
  return evaluate_columns(coulomb_viscous_base(rows).linear_terms, rows);
}

}  // namespace tribench::loop
