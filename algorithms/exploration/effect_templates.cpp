// SPDX-License-Identifier: MIT
#include "algorithms/exploration/effect_templates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>

namespace tribench::loop {
namespace {

// More columns than this are not tried as one block: most would be there for nothing.
constexpr std::size_t kWholeFamily = 10;
// So many or fewer are as cheap together as one of them.
constexpr std::size_t kFewAtoms = 2;

ColumnBlock merged(const ColumnBlock& first, const ColumnBlock& second) {
  ColumnBlock out = first;
  out.insert(out.end(), second.begin(), second.end());
  return out;
}

void add_single_atoms(const Template& main, const std::vector<Template>& templates,
                      std::vector<EffectBlock>& blocks) {
  if (main.atoms.size() <= kFewAtoms) return;
  for (const Template::OneAtom& atom : main.atoms) {
    blocks.push_back({atom.columns});
    for (const Template& other : templates) {
      if (!other.beside) continue;
      const auto same = std::ranges::find(other.atoms, atom.shapes, &Template::OneAtom::shapes);
      if (same != other.atoms.end()) blocks.push_back({merged(atom.columns, same->columns)});
    }
  }
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
    Template::OneAtom one;
    for (const Shape& shape : atom.shapes) one.shapes.push_back(shape.value);
    for (const Expression& column : atom.columns) {
      one.columns.push_back(static_cast<Eigen::Index>(formulas.size()));
      all[found->second].columns.push_back(static_cast<Eigen::Index>(formulas.size()));
      if (atom.curve == SpeedCurve::any) {
        all[found->second].any_curve.push_back(static_cast<Eigen::Index>(formulas.size()));
      }
      formulas.push_back(column);
      curves.push_back(atom.curve);
    }
    all[found->second].atoms.push_back(std::move(one));
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
    add_single_atoms(main, templates, blocks);
    blocks.push_back({main.columns});
    whole = merged(whole, main.columns);
    for (const Template& beside : templates) {
      if (beside.beside) blocks.push_back({merged(main.columns, beside.columns)});
    }
  }
  const bool several = std::ranges::count(templates, false, &Template::beside) > 1;
  if (several && whole.size() <= kWholeFamily) blocks.push_back({whole});
  return blocks;
}

}  // namespace tribench::loop
