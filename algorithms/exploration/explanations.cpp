// SPDX-License-Identifier: MIT
#include "algorithms/exploration/explanations.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <span>

#include "algorithms/effects/effect_library.hpp"
#include "algorithms/exploration/effect_templates.hpp"
#include "algorithms/exploration/foresight.hpp"
#include "algorithms/fitting/symmetric_system.hpp"
#include "algorithms/inference/score_test.hpp"
#include "algorithms/loop_model/smoothers.hpp"
#include "foundation/pivoted_qr.hpp"

namespace tribench::loop {
namespace {

// Root mean squares of an effect that one expects, in the smallest of interest: for one of these
// the prior of the smaller size is likeliest about there (evidence.hpp).
constexpr std::array<double, 4> kSizes = {40, 11, 3, 0.8};
constexpr double kExplainedByBase = 1e-4;  // of a column's squares, on the reference
constexpr std::size_t kSpeedRows = 16;     // in either direction

// Of a narrow column's squares: where a family's own columns leave less, it is that family's.
constexpr double kDrawnByOther = 0.1;

// Of a family's size: what one expects of its misfit, and of what a sensor of temperature that is
// late does not know yet.
constexpr double kMisfit = 0.15;
constexpr double kLateSensor = 0.3;
constexpr Eigen::Index kMisfitColumns = 14;
constexpr Eigen::Index kMisfitCentres = 3;
constexpr double kLeastMisfit = 1e-4;  // of the variance of the direction of most
// Of the mean squares of a block's columns: sums of them that are smaller are no effect of it.
constexpr double kSameShape = 1e-4;

// Where something else is looked for as a whole, and the finer grids for something narrow.
struct PlaceGrid {
  const char* signal;
  Eigen::Index centres;
  std::vector<Eigen::Index> narrow = {};
};
const std::vector<PlaceGrid>& place_grids() {
  static const std::vector<PlaceGrid> kGrids = {
      {"v", 10, {24}}, {"q", 20, {28, 64}}, {"g", 8}, {"T", 6}, {"t", 12}, {"d", 8}, {"a", 8},
      {"v2", 6}};
  return kGrids;
}
// Of a product: the coarser, the position finer.
constexpr Eigen::Index kCoarse = 3;
constexpr Eigen::Index kFiner = 6;

// What is narrow need not be as wide as a radial function, or where one is: of those in rows of
// `centres` from column `first` on, the two to either side of number k.
ColumnBlock neighbours(Eigen::Index k, Eigen::Index centres, Eigen::Index first) {
  const Eigen::Index row = k / centres * centres;
  ColumnBlock out;
  for (Eigen::Index j = std::max(row, k - 2); j <= std::min(row + centres - 1, k + 2); ++j) {
    if (j != k) out.push_back(first + j);
  }
  return out;
}

// What remembers the motion lives in all of it.
std::vector<std::string> signals_of(std::span<const Expression> formulas,
                                    const Observations& reference) {
  std::vector<std::string> signals;
  const auto add = [&](const std::string& signal) {
    if (std::ranges::count(signals, signal) == 0) signals.push_back(signal);
  };
  for (const Expression& formula : formulas) {
    for (const Node& node : formula.nodes()) {
      if (!node.is_variable()) continue;
      const Signal& signal = reference.signals[node.variable];
      if (signal.role == Role::velocity_sign) continue;
      if (!signal.has_memory()) {
        add(signal.role == Role::gravity_sign ? "g" : signal.name);
        continue;
      }
      for (const char* name : {"v", "a", "d"}) {
        if (reference.find(name) != nullptr) add(name);
      }
    }
  }
  return signals;
}

std::vector<std::string> inputs_of(const std::vector<std::string>& signals,
                                   const Observations& reference) {
  std::vector<std::string> inputs;
  for (const std::string& signal : signals) inputs.push_back(input_name(reference, signal));
  return inputs;
}

// With the inertia behind the gear in it, friction with the load would have its room for a misfit
// in the acceleration too, and explain there what others do (docs/decisions.md).
bool holds_inertia(const Atom& atom) {
  return std::ranges::count(atom.shapes, kInertiaInLoad, &Shape::name) > 0;
}

}  // namespace

ExplanationSpace::ExplanationSpace(const Observations& reference,
                                   const std::vector<double>& gear_ratios, double smallest_effect)
    : reference_(reference) {
  add_library(gear_ratios);
  add_places();
  settle_scale();
  add_misfits();
  measure_blocks(smallest_effect);
  settle_speeds();
  std::erase_if(families_, [](const ExplainingFamily& family) { return family.blocks.empty(); });
}

void ExplanationSpace::add_library(const std::vector<double>& gear_ratios) {
  const std::vector<EffectFamily>& library = builtin_effects();
  for (std::size_t f = 0; f < library.size(); ++f) {
    std::vector<std::string> missing;
    std::vector<Atom> atoms =
        instantiate(library[f], f, reference_, gear_ratios_for(reference_, gear_ratios), missing);
    // A column and what of it differs by direction are a block, and so is either direction of it.
    std::erase_if(atoms, [](const Atom& atom) {
      return atom.one_way || atom.last_resort || atom.without_inertia || holds_inertia(atom);
    });
    if (atoms.empty()) {
      untestable_.push_back(library[f].name);
      continue;
    }
    Misfit misfit;
    misfit.first = static_cast<Eigen::Index>(formulas_.size());
    ExplainingFamily family;
    family.name = library[f].name;
    family.blocks = blocks_of(templates_of(atoms, formulas_, curves_));
    misfit.count = static_cast<Eigen::Index>(formulas_.size()) - misfit.first;
    const std::vector<std::string> signals = signals_of(
        std::span(formulas_).subspan(static_cast<std::size_t>(misfit.first)), reference_);
    family.inputs = inputs_of(signals, reference_);
    std::vector<Expression> main;
    for (const Atom& atom : atoms) {
      if (!atom.beside_another) main.insert(main.end(), atom.columns.begin(), atom.columns.end());
    }
    std::vector<std::string> own = signals_of(main, reference_);
    const bool remembers = std::ranges::count(own, "d") > 0;
    if (own.size() > 1 && !remembers) std::erase(own, "v");
    family.characteristic = inputs_of(own, reference_);
    for (const std::string& signal : signals) {
      if (SignalAxis axis(reference_, signal); axis.varies()) misfit.axes.push_back(axis);
    }
    misfit.late = std::ranges::count(signals, "T") > 0;
    families_.push_back(std::move(family));
    misfits_.push_back(std::move(misfit));
  }
}

// Where some movement of the reference warms or cools.
void ExplanationSpace::add_late_sensor() {
  const Signal* warming = reference_.find(kWarming);
  if (warming == nullptr) return;
  const Eigen::Map<const Eigen::VectorXd> rate(warming->values.data(), std::ssize(warming->values));
  const Eigen::MatrixXd late = rate.asDiagonal() * base_columns(reference_);
  const Eigen::RowVectorXd squares = late.colwise().squaredNorm();
  if (!(squares.minCoeff() > 0)) return;
  const Eigen::RowVectorXd mean = squares / static_cast<double>(late.rows());
  late_sensor_ = LateSensor{{reference_, "T"}, mean.cwiseSqrt().cwiseInverse(), {}};
}

// f(T) is the base times a function of the temperature, and with the sensor a time s behind it is
// f + s (dT/dt) f'(T): the base times the warming, at each temperature its own.
Eigen::MatrixXd ExplanationSpace::late_columns(const Observations& rows) const {
  const Signal& warming = *rows.find(kWarming);
  const Eigen::Map<const Eigen::VectorXd> rate(warming.values.data(), std::ssize(warming.values));
  const Eigen::MatrixXd late =
      rate.asDiagonal() * base_columns(rows) * late_sensor_->scale.asDiagonal();
  const Eigen::MatrixXd radial = radial_columns(late_sensor_->axis.unit(rows), kMisfitCentres);
  Eigen::MatrixXd out(late.rows(), late.cols() * (1 + kMisfitCentres));
  out << late, column_products(radial, late);
  return out;
}

void ExplanationSpace::add_places() {
  auto next = static_cast<Eigen::Index>(formulas_.size());
  const auto add = [&](Place place, bool each, ExplainingFamily& family) {
    const Eigen::Index size = place_columns(place, reference_).cols();
    ColumnBlock whole;
    for (Eigen::Index j = next; j < next + size; ++j) {
      whole.push_back(j);
      if (each) family.blocks.push_back({{j}, 1, neighbours(j - next, place.centres[0], next)});
    }
    if (!each) family.blocks.push_back({whole});
    places_.push_back(std::move(place));
    next += size;
  };
  std::map<std::string, SignalAxis> axes;
  for (const PlaceGrid& grid : place_grids()) {
    const SignalAxis axis(reference_, grid.signal);
    if (!axis.varies()) continue;
    axes.emplace(grid.signal, axis);
    const std::string input = input_name(reference_, grid.signal);
    ExplainingFamily family;
    family.name = "unknown:" + input;
    family.unknown = true;
    family.inputs = {input};
    add({{axis}, {grid.centres}}, false, family);
    for (const Eigen::Index narrow : grid.narrow) add({{axis}, {narrow}}, true, family);
    families_.push_back(std::move(family));
  }
  for (const auto& [first, second] : smoothed_pairs()) {
    const auto a = axes.find(std::string(first));
    const auto b = axes.find(std::string(second));
    if (a == axes.end() || b == axes.end()) continue;
    const std::vector<std::string> inputs = {input_name(reference_, first),
                                             input_name(reference_, second)};
    ExplainingFamily family;
    family.name = fmt::format("unknown:{}", fmt::join(inputs, " x "));
    family.unknown = true;
    family.inputs = inputs;
    const auto centres = [](std::string_view name) { return name == "q" ? kFiner : kCoarse; };
    add({{a->second, b->second}, {centres(first), centres(second)}}, false, family);
    families_.push_back(std::move(family));
  }
}

// What the base explains on the reference is no column of anything.
void ExplanationSpace::settle_scale() {
  const Eigen::MatrixXd all = raw_columns(reference_);
  const Eigen::MatrixXd base = base_columns(reference_);
  const Eigen::MatrixXd own = PivotedQr(base).basis();
  const Eigen::RowVectorXd explained = (own.transpose() * all).colwise().squaredNorm();
  const auto rows = static_cast<double>(reference_.rows());
  scale_.setZero(all.cols());
  std::vector<char> dead(static_cast<std::size_t>(all.cols()), 0);
  for (Eigen::Index j = 0; j < all.cols(); ++j) {
    const double squares = all.col(j).squaredNorm();
    const bool vanishes = !(squares - explained[j] > kExplainedByBase * squares);
    dead[static_cast<std::size_t>(j)] = vanishes || !std::isfinite(squares) ? 1 : 0;
    if (dead[static_cast<std::size_t>(j)] == 0) scale_[j] = 1 / std::sqrt(squares / rows);
  }
  for (ExplainingFamily& family : families_) {
    for (EffectBlock& block : family.blocks) {
      const auto is_dead = [&](Eigen::Index j) { return dead[static_cast<std::size_t>(j)] != 0; };
      std::erase_if(block.columns, is_dead);
      std::erase_if(block.misfit, is_dead);
    }
    std::erase_if(family.blocks, [](const EffectBlock& block) { return block.columns.empty(); });
    std::ranges::stable_sort(family.blocks, {}, &EffectBlock::columns);
    const auto same = [](const EffectBlock& a, const EffectBlock& b) {
      return a.columns == b.columns;
    };
    const auto again = std::unique(family.blocks.begin(), family.blocks.end(), same);
    family.blocks.erase(again, family.blocks.end());
    if (family.blocks.empty()) untestable_.push_back(family.name);
  }
}

// The family's shapes, the same times radial functions of each of its signals.
Eigen::MatrixXd ExplanationSpace::shaped(const Misfit& misfit, const Observations& rows,
                                         const Eigen::MatrixXd& formulas) const {
  const Eigen::MatrixXd own = formulas.middleCols(misfit.first, misfit.count) *
                              scale_.segment(misfit.first, misfit.count).asDiagonal();
  const auto axes = static_cast<Eigen::Index>(misfit.axes.size());
  Eigen::MatrixXd out(own.rows(), own.cols() * (1 + kMisfitCentres * axes));
  out.leftCols(own.cols()) = own;
  Eigen::Index next = own.cols();
  for (const SignalAxis& axis : misfit.axes) {
    const Eigen::MatrixXd radial = radial_columns(axis.unit(rows), kMisfitCentres);
    out.middleCols(next, own.cols() * kMisfitCentres) = column_products(radial, own);
    next += own.cols() * kMisfitCentres;
  }
  return out;
}

// Columns -> the directions of most variance over the reference that the base does not have; the
// first is expected to be as large as `size`.
Eigen::MatrixXd ExplanationSpace::fold_of(const Eigen::MatrixXd& all, double size) const {
  const Eigen::MatrixXd base = base_columns(reference_);
  const auto rows = static_cast<double>(reference_.rows());
  EvidenceSums sums;
  sums.add(base, all, Eigen::VectorXd::Zero(base.rows()));  // no torque is looked at
  const EigenParts parts = eigen_parts_symmetric(EvidenceTable(sums).gram());
  const double most = parts.values.maxCoeff();
  const Eigen::Index kept =
      std::min<Eigen::Index>(kMisfitColumns, (parts.values.array() > kLeastMisfit * most).count());
  Eigen::MatrixXd fold = parts.vectors.rightCols(kept);
  const Eigen::VectorXd values = parts.values.tail(kept);
  for (Eigen::Index k = 0; k < kept; ++k) {
    // Later directions are smaller, but less than variance would have it: nobody knows the misfit.
    fold.col(k) *= size * std::sqrt(std::sqrt(values[k] / most) * rows / values[k]);
  }
  return fold;
}

void ExplanationSpace::add_misfits() {
  const Eigen::MatrixXd formulas = evaluate_columns(formulas_, reference_);
  const auto numbers_of = [&](const Eigen::MatrixXd& fold) {
    ColumnBlock added(static_cast<std::size_t>(fold.cols()));
    std::iota(added.begin(), added.end(), scale_.size());
    scale_.conservativeResize(scale_.size() + fold.cols());
    scale_.tail(fold.cols()).setOnes();
    return added;
  };
  const auto give = [&](std::size_t family, const ColumnBlock& added) {
    for (EffectBlock& block : families_[family].blocks) {
      block.misfit.insert(block.misfit.end(), added.begin(), added.end());
    }
  };
  for (std::size_t f = 0; f < misfits_.size(); ++f) {
    misfits_[f].fold = fold_of(shaped(misfits_[f], reference_, formulas), kMisfit);
    give(f, numbers_of(misfits_[f].fold));
  }
  add_late_sensor();
  if (!late_sensor_) return;
  late_sensor_->fold = fold_of(late_columns(reference_), kLateSensor);
  const ColumnBlock late = numbers_of(late_sensor_->fold);
  for (std::size_t f = 0; f < misfits_.size(); ++f) {
    if (misfits_[f].late) give(f, late);
  }
}

// Something narrow that a family of the library draws is that family's, and nothing else: a bump at
// standstill is a Stribeck curve. all: the columns on the reference, without the base.
void ExplanationSpace::leave_to_the_library(const Eigen::MatrixXd& all) {
  const auto is_narrow = [](const EffectBlock& block) { return block.columns.size() == 1; };
  std::vector<Eigen::Index> narrow;
  for (const ExplainingFamily& family : families_) {
    if (!family.unknown) continue;
    for (const EffectBlock& block : family.blocks) {
      if (is_narrow(block)) narrow.push_back(block.columns.front());
    }
  }
  const Eigen::MatrixXd bumps = all(Eigen::all, narrow);
  const Eigen::RowVectorXd squares = bumps.colwise().squaredNorm();
  Eigen::RowVectorXd left = squares;
  for (const ExplainingFamily& family : families_) {
    if (family.unknown) continue;
    for (const EffectBlock& block : family.blocks) {
      const Eigen::MatrixXd basis = orthonormal_basis(all(Eigen::all, block.columns));
      left = left.cwiseMin(squares - (basis.transpose() * bumps).colwise().squaredNorm());
    }
  }
  std::set<Eigen::Index> drawn;
  for (Eigen::Index k = 0; k < left.size(); ++k) {
    if (left[k] < kDrawnByOther * squares[k]) drawn.insert(narrow[static_cast<std::size_t>(k)]);
  }
  for (ExplainingFamily& family : families_) {
    if (!family.unknown) continue;
    std::erase_if(family.blocks, [&](const EffectBlock& block) {
      return is_narrow(block) && drawn.contains(block.columns.front());
    });
  }
}

// The size of an effect and what a misfit has of it, over the reference; then every block in
// several sizes.
void ExplanationSpace::measure_blocks(double smallest_effect) {
  const Eigen::MatrixXd base = base_columns(reference_);
  Eigen::MatrixXd all = columns(reference_);
  all -= base * PivotedQr(base).solve_each(all);
  leave_to_the_library(all);
  for (ExplainingFamily& family : families_) {
    for (EffectBlock& block : family.blocks) {
      const Eigen::MatrixXd own = all(Eigen::all, block.columns);
      Eigen::MatrixXd gram = own.transpose() * own;
      const double squares = gram.trace();
      block.metric = gram / squares;
      gram.diagonal().array() += kSameShape * squares / static_cast<double>(gram.cols());
      if (block.misfit.empty()) continue;
      block.shared = gram.llt().solve(own.transpose() * all(Eigen::all, block.misfit));
    }
    std::vector<EffectBlock> sized;
    for (const double size : kSizes) {
      for (EffectBlock& block : family.blocks) {
        block.size = size * smallest_effect;
        sized.push_back(block);
      }
    }
    family.blocks = std::move(sized);
  }
}

SpeedCurve ExplanationSpace::curve_of(const EffectBlock& block) const {
  for (const Eigen::Index j : block.columns) {
    const auto column = static_cast<std::size_t>(j);
    if (column < curves_.size() && curves_[column] != SpeedCurve::any) return curves_[column];
  }
  return SpeedCurve::any;
}

void ExplanationSpace::settle_speeds() {
  const std::vector<double>& v = reference_.find("v")->values;
  std::vector<std::size_t> order(v.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return std::abs(v[i]); });
  std::vector<char> kept(v.size(), 0);
  for (const double direction : {1.0, -1.0}) {
    std::vector<std::size_t> same;
    std::ranges::copy_if(order, std::back_inserter(same),
                         [&](std::size_t i) { return direction * v[i] > 0; });
    for (std::size_t k = 0; k < kSpeedRows && !same.empty(); ++k) {
      kept[same[k * (same.size() - 1) / (kSpeedRows - 1)]] = 1;
    }
  }
  const Observations rows = reference_.select(kept);
  speeds_ = {rows.find("v")->values, base_columns(rows), columns(rows)};
}

Eigen::MatrixXd ExplanationSpace::place_columns(const Place& place,
                                                const Observations& rows) const {
  Eigen::MatrixXd out = radial_columns(place.axes[0].unit(rows), place.centres[0]);
  if (place.axes.size() > 1) {
    out = column_products(out, radial_columns(place.axes[1].unit(rows), place.centres[1]));
  }
  const Signal* direction = rows.find("sgn_v");
  if (direction == nullptr) return out;
  const Eigen::Map<const Eigen::VectorXd> sign(direction->values.data(), out.rows());
  Eigen::MatrixXd both(out.rows(), 2 * out.cols());
  both << out, sign.asDiagonal() * out;
  return both;
}

Eigen::MatrixXd ExplanationSpace::raw_columns(const Observations& rows) const {
  std::vector<Eigen::MatrixXd> parts = {evaluate_columns(formulas_, rows)};
  for (const Place& place : places_) parts.push_back(place_columns(place, rows));
  Eigen::Index count = 0;
  for (const Eigen::MatrixXd& part : parts) count += part.cols();
  Eigen::MatrixXd out(parts.front().rows(), count);
  Eigen::Index next = 0;
  for (const Eigen::MatrixXd& part : parts) {
    out.middleCols(next, part.cols()) = part;
    next += part.cols();
  }
  return out;
}

Eigen::MatrixXd ExplanationSpace::columns(const Observations& rows) const {
  const Eigen::MatrixXd raw = raw_columns(rows);
  Eigen::MatrixXd out(raw.rows(), scale_.size());
  out.leftCols(raw.cols()) = raw * scale_.head(raw.cols()).asDiagonal();
  Eigen::Index next = raw.cols();
  for (const Misfit& misfit : misfits_) {
    out.middleCols(next, misfit.fold.cols()) = shaped(misfit, rows, raw) * misfit.fold;
    next += misfit.fold.cols();
  }
  if (late_sensor_) {
    out.rightCols(late_sensor_->fold.cols()) = late_columns(rows) * late_sensor_->fold;
  }
  return out;
}

Eigen::MatrixXd ExplanationSpace::base_columns(const Observations& rows) const {
  return evaluate_columns(coulomb_viscous_base(rows).linear_terms, rows);
}

}  // namespace tribench::loop
