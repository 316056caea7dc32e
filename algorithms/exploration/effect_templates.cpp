// SPDX-License-Identifier: MIT
#include "algorithms/exploration/effect_templates.hpp"

#include <fmt/format.h>

#include <map>
#include <string>

namespace tribench::loop {
namespace {

// More columns than this are not tried as one block: most would be there for nothing.
constexpr std::size_t kWholeFamily = 10;

ColumnBlock merged(const ColumnBlock& first, const ColumnBlock& second) {
  ColumnBlock out = first;
  out.insert(out.end(), second.begin(), second.end());
  return out;
}

}  // namespace

std::vector<Template> templates_of(const std::vector<Atom>& atoms,
                                   std::vector<Expression>& formulas,
                                   std::vector<SpeedCurve>& curves) {
  std::vector<Template> all;
  std::map<std::string, std::size_t> place;
  for (const Atom& atom : atoms) {
    // Gear ratios exclude one another: each is a template of its own.
    std::string key = atom.label;
    for (const Shape& shape : atom.shapes) {
      if (shape.values != ShapeValues::gear_ratios) continue;
      key += fmt::format(" {}={}", shape.name, shape.value);
    }
    const auto [found, is_new] = place.try_emplace(key, all.size());
    if (is_new) all.push_back({{}, atom.beside_another});
    for (const Expression& column : atom.columns) {
      all[found->second].columns.push_back(static_cast<Eigen::Index>(formulas.size()));
      if (atom.curve == SpeedCurve::any) {
        all[found->second].any_curve.push_back(static_cast<Eigen::Index>(formulas.size()));
      }
      formulas.push_back(column);
      curves.push_back(atom.curve);
    }
  }
  for (std::size_t k = 0, count = all.size(); k < count; ++k) {
    const ColumnBlock& free = all[k].any_curve;
    if (free.empty() || free.size() == all[k].columns.size()) continue;
    all.push_back({free, all[k].beside, free});
  }
  return all;
}

std::vector<EffectBlock> blocks_of(const std::vector<Template>& templates) {
  std::vector<EffectBlock> blocks;
  ColumnBlock whole;
  for (const Template& main : templates) {
    if (main.beside) continue;
    blocks.push_back({main.columns});
    whole = merged(whole, main.columns);
    for (const Template& beside : templates) {
      if (beside.beside) blocks.push_back({merged(main.columns, beside.columns)});
    }
  }
  const bool several = !blocks.empty() && whole.size() > blocks.front().columns.size();
  if (several && whole.size() <= kWholeFamily) blocks.push_back({whole});
  return blocks;
}

}  // namespace tribench::loop
