// SPDX-License-Identifier: MIT
#include "algorithms/loop_model/bristles.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "algorithms/expression/build.hpp"
#include "algorithms/fitting/symmetric_system.hpp"
#include "algorithms/inference/column_products.hpp"
#include "algorithms/inference/whitening.hpp"
#include "algorithms/loop_model/bristle_path.hpp"
#include "foundation/elementary.hpp"

namespace tribench::loop {
namespace {

constexpr double kGridStep = 1.15;
constexpr std::size_t kElements = 4;
// How the elements' limits grow: from nearly one curve to two decades.
constexpr std::array<double, 4> kGrowths = {1.4, 2.0, 3.0, 4.5};
constexpr std::size_t kParts = 10;
constexpr double kStudent9 = 2.262;  // 97.5 % of Student's t with kParts - 1 degrees of freedom
constexpr double kRidge = 1e-11;     // of columns of length 1: dependent ones share

// Sums of products of columns, the target last.
struct Sums {
  Eigen::MatrixXd all;
  std::vector<Eigen::MatrixXd> part;
};

struct Solution {
  double error = std::numeric_limits<double>::infinity();  // sum of squares
  Eigen::VectorXd coefficients;
};

// Least squares by its sums; `first` free coefficients, those behind them 0 or above: the best of
// all subsets, of four at most.
Solution solve(const Eigen::MatrixXd& sums, Eigen::Index first) {
  const Eigen::Index p = sums.rows() - 1;
  const Eigen::Index signed_ones = p - first;
  Solution best;
  for (unsigned subset = 0; subset < (1U << signed_ones); ++subset) {
    std::vector<Eigen::Index> used;
    for (Eigen::Index j = 0; j < p; ++j) {
      if (j < first || ((subset >> (j - first)) & 1U) != 0) used.push_back(j);
    }
    Eigen::MatrixXd normal = sums(used, used);
    const Eigen::VectorXd length = normal.diagonal().cwiseSqrt().cwiseMax(1e-300);
    normal = length.cwiseInverse().asDiagonal() * normal * length.cwiseInverse().asDiagonal();
    normal.diagonal().array() += kRidge;
    const Eigen::VectorXd right = sums(used, p);
    const Eigen::VectorXd x =
        solve_symmetric(normal, right.cwiseQuotient(length)).cwiseQuotient(length);
    if ((x.tail(static_cast<Eigen::Index>(used.size()) - first).array() < 0).any()) continue;
    const double error = sums(p, p) - 2 * x.dot(right) + x.dot(sums(used, used) * x);
    if (!(error < best.error)) continue;
    best.error = error;
    best.coefficients.setZero(p);
    best.coefficients(used) = x;
  }
  return best;
}

struct Shape {
  BristleLaw law = BristleLaw::dahl;
  BristleStart start = BristleStart::relaxed;
  double growth = 1;
};

// Least squares of one model without and with bristles, in ten parts of its rows.
class Fit {
 public:
  Fit(const LoopModel& others, const Observations& data, const std::vector<char>& rows)
      : data_(data), path_(path_of(data)) {
    const bool by_movement = data.movements().size() >= kParts;
    part_.resize(kParts);
    std::vector<int> movement;
    for (std::size_t i = 0; i < data.rows(); ++i) {
      if (rows[i] == 0) continue;
      const std::size_t part = by_movement ? static_cast<std::size_t>(data.movement[i]) % kParts
                                           : i * kParts / data.rows();
      part_[part].push_back(static_cast<Eigen::Index>(used_.size()));
      used_.push_back(static_cast<Eigen::Index>(i));
      movement.push_back(data.movement[i]);
    }
    clusters_ = make_clusters(movement, 1);
    Eigen::VectorXd target = target_vector(data);
    if (!others.base.formula.empty()) {
      target -= evaluate_column(others.base.formula, SignalTable(data));
    }
    target_ = target(used_);
    fixed_ = evaluate_columns(linear_columns(others), data)(used_, Eigen::all);
  }

  Eigen::Index fixed() const { return fixed_.cols(); }
  std::size_t rows() const { return used_.size(); }
  // What the rows are worth.
  double effective_rows() const {
    return static_cast<double>(rows()) / (noise_ ? noise_->row_inflation() : 1);
  }

  // From here on errors are looked at as this noise makes them: what it carries from row to row
  // taken off.
  void set_noise(const Noise& noise) { noise_ = noise; }

  // Of rows with these bristles, everything refitted. correlated: they are to be whitened.
  Noise noise_beside(const Shape& shape, double longest, bool correlated) const {
    const Eigen::MatrixXd more = columns(shape, longest);
    const Solution at = solve(sums(more).all, fixed());
    Eigen::VectorXd residual = target_ - fixed_ * at.coefficients.head(fixed());
    residual -= more * at.coefficients.tail(more.cols());
    Noise noise = estimate_noise(residual, clusters_, static_cast<std::size_t>(fixed()) + 2,
                                 1e-9 * target_.cwiseAbs().maxCoeff());
    noise.whitened = correlated;
    return noise;
  }

  std::vector<double> slidings(const Shape& shape, double longest) const {
    std::vector<double> all;
    for (double one = longest; all.size() < slidings_of(shape); one /= shape.growth) {
      all.push_back(one);
    }
    return all;
  }

  Sums with_bristles(const Shape& shape, double longest) const {
    return sums(columns(shape, longest));
  }

  // Of the fixed columns and these, which are of the used rows.
  Sums sums(const Eigen::MatrixXd& more) const {
    Eigen::MatrixXd table(target_.size(), fixed_.cols() + more.cols() + 1);
    table << fixed_, more, target_;
    if (noise_) table = whitened(std::move(table), clusters_, *noise_);
    Sums out;
    out.all.setZero(table.cols(), table.cols());
    for (const std::vector<Eigen::Index>& part : part_) {
      const Eigen::MatrixXd rows = table(part, Eigen::all);
      out.part.push_back(gram_of(rows));
      out.all += out.part.back();
    }
    return out;
  }

  const std::vector<Eigen::Index>& used() const { return used_; }

  // The longest deflections to try: from half the way between two rows (what slides sooner is not
  // seen to stick), of the shortest element, to what no stroke is long enough for.
  std::vector<double> grid(const Shape& shape) const {
    std::vector<double> ways;
    double longest = 0;
    double stroke = 0;
    for (const PathStep& step : path_) {
      const double way = std::abs(step.on);
      if (way > 0) ways.push_back(way);
      stroke = step.starts || step.back != 0 ? way : stroke + way;
      longest = std::max(longest, stroke);
    }
    if (ways.empty()) return {};
    const auto middle = ways.begin() + static_cast<std::ptrdiff_t>(ways.size() / 2);
    std::ranges::nth_element(ways, middle);
    std::vector<double> all;
    for (double one = 0.5 * *middle / slidings(shape, 1).back(); one < longest; one *= kGridStep) {
      all.push_back(one);
    }
    return all;
  }

 private:
  static std::size_t slidings_of(const Shape& shape) {
    return shape.law == BristleLaw::maxwell_slip ? kElements : 1;
  }

  Eigen::MatrixXd columns(const Shape& shape, double longest) const {
    const std::vector<double> all = slidings(shape, longest);
    const bool has_rate = shape.law == BristleLaw::lugre;
    const auto elements = static_cast<Eigen::Index>(all.size());
    Eigen::MatrixXd out(target_.size(), elements + (has_rate ? 1 : 0));
    for (Eigen::Index k = 0; k < elements; ++k) {
      const double sliding = all[static_cast<std::size_t>(k)];
      const Eigen::VectorXd z = deflection(shape.law, shape.start, sliding, path_);
      out.col(k) = z(used_);
      if (has_rate) out.col(elements) = deflection_rate(z, sliding, data_)(used_);
    }
    return out;
  }

  const Observations& data_;
  std::vector<PathStep> path_;                   // of every row
  std::vector<Eigen::Index> used_;               // rows, ascending
  std::vector<std::vector<Eigen::Index>> part_;  // places among these
  Clusters clusters_;
  std::optional<Noise> noise_;
  Eigen::VectorXd target_;
  Eigen::MatrixXd fixed_;
};

// The lowest point of a curve over the grid and the stiffness there.
class Profile {
 public:
  // first, elements: where the stiffnesses stand among the coefficients.
  void add(const Solution& at, Eigen::Index first, Eigen::Index elements) {
    error_.push_back(at.error);
    const bool known = at.coefficients.size() > 0;
    stiffness_.push_back(known ? at.coefficients.segment(first, elements).sum() : 0);
  }
  std::size_t lowest() const {
    return static_cast<std::size_t>(std::ranges::min_element(error_) - error_.begin());
  }
  bool is_inside() const {
    if (error_.size() < 3) return false;
    const std::size_t at = lowest();
    return at > 0 && at + 1 < error_.size() && std::isfinite(error_[at]);
  }
  // Of a parabola through the lowest point and its neighbours: in steps of the grid, -1 to 1.
  double offset() const {
    const std::size_t at = lowest();
    const double bend = error_[at - 1] - 2 * error_[at] + error_[at + 1];
    return bend > 0 ? std::clamp(0.5 * (error_[at - 1] - error_[at + 1]) / bend, -1.0, 1.0) : 0;
  }
  double stiffness() const {
    if (stiffness_.empty()) return 0;
    const std::size_t at = lowest();
    if (!is_inside()) return stiffness_[at];
    const double x = offset();
    return stiffness_[at] + 0.5 * x * (stiffness_[at + 1] - stiffness_[at - 1]) +
           0.5 * x * x * (stiffness_[at + 1] - 2 * stiffness_[at] + stiffness_[at - 1]);
  }

 private:
  std::vector<double> error_;
  std::vector<double> stiffness_;
};

// The longest deflections of one shape: a grid, and the best found between its points.
struct Scan {
  Shape shape;
  Profile all;
  std::vector<Profile> without;  // one part of the rows each
  double longest = 0;
  double error = std::numeric_limits<double>::infinity();  // infinite at the grid's ends
};

// Parabolas through three points, closer each time.
void refine(Scan& out, const Fit& fit, const std::vector<double>& grid) {
  if (!out.all.is_inside()) return;
  double centre = grid[out.all.lowest()] * elementary::pow(kGridStep, out.all.offset());
  double step = kGridStep;
  for (int round = 0; round < 3; ++round) {
    step = std::sqrt(std::sqrt(step));
    Profile near;
    for (const double one : {centre / step, centre, centre * step}) {
      const Solution at = solve(fit.with_bristles(out.shape, one).all, fit.fixed());
      near.add(at, fit.fixed(), 1);
      if (!(at.error < out.error)) continue;
      out.error = at.error;
      out.longest = one;
    }
    centre = near.is_inside() ? centre * elementary::pow(step, near.offset()) : out.longest;
  }
}

Scan scan(const Fit& fit, const Shape& shape, bool in_parts) {
  Scan out;
  out.shape = shape;
  out.without.resize(in_parts ? kParts : 0);
  const std::vector<double> grid = fit.grid(shape);
  for (const double longest : grid) {
    const Sums sums = fit.with_bristles(shape, longest);
    const auto elements = static_cast<Eigen::Index>(fit.slidings(shape, longest).size());
    out.all.add(solve(sums.all, fit.fixed()), fit.fixed(), elements);
    for (std::size_t k = 0; k < out.without.size(); ++k) {
      out.without[k].add(solve(sums.all - sums.part[k], fit.fixed()), fit.fixed(), elements);
    }
  }
  refine(out, fit, grid);
  return out;
}

Scan best_start(const Fit& fit) {
  Scan best;
  for (const BristleStart start :
       {BristleStart::relaxed, BristleStart::as_left, BristleStart::bent}) {
    Scan one = scan(fit, {BristleLaw::dahl, start, 1}, false);
    if (one.error < best.error) best = std::move(one);
  }
  return best;
}

// The log of a stiffness over the laws, each weighed by its likelihood: what they agree on is
// known better than which of them it is (Buckland, Burnham, Augustin 1997).
class LogStiffness {
 public:
  // nats: the negative log evidence of a law.
  void add(double nats, double stiffness) {
    if (stiffness > 0) all_.emplace_back(nats, elementary::log(stiffness));
  }
  bool is_known() const { return !all_.empty(); }
  double mean() const {
    return average([](double one) { return one; });
  }
  double variance() const {
    const double middle = mean();
    return average([middle](double one) { return (one - middle) * (one - middle); });
  }

 private:
  template <typename Value>
  double average(const Value& value) const {
    const double least = std::ranges::min(all_).first;
    double sum = 0;
    double weights = 0;
    for (const auto& [nats, one] : all_) {
      const double weight = elementary::exp(least - nats);
      weights += weight;
      sum += weight * value(one);
    }
    return sum / weights;
  }

  std::vector<std::pair<double, double>> all_;  // nats, log stiffness
};

struct Laws {
  Scan best;
  LogStiffness stiffness;
};

// Dahl's law is LuGre's without damping, which is held to be there where the rows pay for one more
// number (Schwarz 1978); four elements hold neither and are not held by them: they are compared by
// their likelihood, less a nat for each number more (Akaike 1974).
Laws scan_laws(const Fit& fit, BristleStart start) {
  Laws out;
  double least = std::numeric_limits<double>::infinity();
  const auto try_shape = [&](const Shape& shape, double price) {
    Scan one = scan(fit, shape, false);
    const double nats = 0.5 * fit.effective_rows() * elementary::log(one.error) + price;
    if (!std::isfinite(nats)) return;
    out.stiffness.add(nats, one.all.stiffness());
    if (!(nats < least)) return;
    least = nats;
    out.best = std::move(one);
  };
  try_shape({BristleLaw::dahl, start, 1}, 0);
  try_shape({BristleLaw::lugre, start, 1}, 0.5 * elementary::log(fit.effective_rows()));
  for (const double growth : kGrowths) {
    try_shape({BristleLaw::maxwell_slip, start, growth}, kElements);
  }
  if (std::isfinite(least)) out.best = scan(fit, out.best.shape, true);
  return out;
}

// The mean over the laws; how far they lie apart is a part of the interval.
void set_stiffness(Bristles& out, const Laws& laws) {
  double mean = 0;
  std::vector<double> logs;
  out.stiffness = elementary::exp(laws.stiffness.mean());
  for (const Profile& one : laws.best.without) {
    const double stiffness = one.stiffness();
    if (!(stiffness > 0)) continue;
    logs.push_back(elementary::log(stiffness));
    mean += logs.back();
  }
  if (logs.size() < kParts) {
    out.low = 0;
    out.high = std::numeric_limits<double>::infinity();
    return;
  }
  mean /= static_cast<double>(kParts);
  double spread = 0;
  for (const double one : logs) spread += (one - mean) * (one - mean);
  const double parts = kParts;
  const double half =
      kStudent9 * std::sqrt((parts - 1) / parts * spread + laws.stiffness.variance());
  out.low = out.stiffness * elementary::exp(-half);
  out.high = out.stiffness * elementary::exp(half);
}

// Sum of squares of the model with the family's own columns, coefficients anew.
double closed_form_error(const Fit& fit, const LoopModel& model, std::size_t family,
                         const Observations& data) {
  std::vector<Expression> own;
  for (const Atom& atom : model.atoms) {
    if (atom.family == family) own.insert(own.end(), atom.columns.begin(), atom.columns.end());
  }
  const Eigen::MatrixXd columns = evaluate_columns(own, data)(fit.used(), Eigen::all);
  const Sums sums = fit.sums(columns);
  return solve(sums.all, sums.all.rows() - 1).error;
}

}  // namespace

std::string_view bristle_law_name(BristleLaw law) {
  switch (law) {
    case BristleLaw::dahl:
      return "dahl";
    case BristleLaw::lugre:
      return "lugre";
    case BristleLaw::maxwell_slip:
      break;
  }
  return "maxwell_slip";
}

std::optional<std::size_t> presliding_family(const LoopModel& model, const Observations& data) {
  for (const Atom& atom : model.atoms) {
    for (const Signal* signal : signals_read(model, atom.family, data)) {
      if (is_distance(signal->name)) return atom.family;
    }
  }
  return std::nullopt;
}

std::optional<Bristles> fit_bristles(const LoopModel& model, std::size_t family,
                                     const Observations& data, const std::vector<char>& rows,
                                     bool correlated) {
  if (data.find("d") == nullptr || data.find("v") == nullptr) return std::nullopt;
  Bristles out;
  out.family = family;
  out.others = model.without(family);
  Fit fit(out.others, data, rows);
  if (fit.rows() < 10 * kParts) return std::nullopt;
  const Scan first = best_start(fit);
  if (!std::isfinite(first.error)) return std::nullopt;
  fit.set_noise(fit.noise_beside(first.shape, first.longest, correlated));
  const Laws laws = scan_laws(fit, first.shape.start);
  const Scan& scan = laws.best;
  if (!std::isfinite(scan.error) || !laws.stiffness.is_known()) return std::nullopt;
  const double bar = elementary::exp(elementary::log(fit.effective_rows()) / fit.effective_rows());
  if (scan.error > bar * closed_form_error(fit, model, family, data)) return std::nullopt;
  const double longest = scan.longest;
  const Solution best = solve(fit.with_bristles(scan.shape, longest).all, fit.fixed());
  out.law = scan.shape.law;
  out.start = scan.shape.start;
  out.others.coefficients = best.coefficients.head(fit.fixed());
  const std::vector<double> slidings = fit.slidings(scan.shape, longest);
  for (std::size_t k = 0; k < slidings.size(); ++k) {
    const double stiffness = best.coefficients[fit.fixed() + static_cast<Eigen::Index>(k)];
    if (!(stiffness > 0)) continue;
    out.elements.push_back({slidings[k], stiffness});
    out.sliding = std::max(out.sliding, slidings[k]);
  }
  if (out.elements.empty()) return std::nullopt;
  if (out.law == BristleLaw::lugre) out.damping = best.coefficients[best.coefficients.size() - 1];
  set_stiffness(out, laws);
  return out;
}

Eigen::VectorXd predict(const Bristles& bristles, const Observations& data) {
  const std::vector<PathStep> path = path_of(data);
  Eigen::VectorXd sum = predict(bristles.others, data);
  for (const Bristles::Element& one : bristles.elements) {
    const Eigen::VectorXd z = deflection(bristles.law, bristles.start, one.sliding, path);
    sum += one.stiffness * z;
    if (bristles.damping > 0) sum += bristles.damping * deflection_rate(z, one.sliding, data);
  }
  return sum;
}

StatefulFormula formula_of(const Bristles& bristles, const Observations& data) {
  using namespace build;
  const std::vector<std::string> names = data.names();
  const auto at = static_cast<std::size_t>(std::ranges::find(names, "v") - names.begin());
  const Expression v = input(at);
  StatefulFormula out;
  out.first_state = names.size();
  out.formula = formula_of(bristles.others);
  for (std::size_t k = 0; k < bristles.elements.size(); ++k) {
    const Bristles::Element& one = bristles.elements[k];
    std::string name = bristles.elements.size() == 1 ? "z" : fmt::format("z{}", k + 1);
    while (std::ranges::count(names, name) > 0) name += "_";
    const bool slips = bristles.law == BristleLaw::maxwell_slip;
    out.states.push_back(
        {std::move(name), slips ? StateLaw::slip : StateLaw::dahl, {at}, {one.sliding}});
    const Expression z = input(out.first_state + k);
    out.formula = out.formula + constant(one.stiffness) * z;
    if (!(bristles.damping > 0)) continue;
    out.formula = out.formula + constant(bristles.damping) *
                                    (v - function(Op::abs, v) * z / constant(one.sliding));
  }
  return out;
}

}  // namespace tribench::loop
