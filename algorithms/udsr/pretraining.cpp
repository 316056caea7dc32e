// SPDX-License-Identifier: MIT
#include "algorithms/udsr/pretraining.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

#include "algorithms/expression/edit.hpp"
#include "algorithms/expression/evaluate.hpp"
#include "algorithms/udsr/linear_token.hpp"
#include "algorithms/udsr/scoring.hpp"
#include "foundation/error.hpp"

namespace tribench::udsr {
namespace {

constexpr std::size_t kInputs = 8;
constexpr int kLinearDegree = 3;
constexpr std::size_t kImaginedRows = 48;
constexpr double kLargestImagined = 1e100;  // its square is still finite

// Writes formulas in tokens by name.
class Writer {
 public:
  explicit Writer(const TokenLibrary& library) : library_(library) {}

  Sequence leaf(std::string_view name) const { return {id(name)}; }
  Sequence apply(std::string_view op, const Sequence& a) const { return joined(op, a, {}); }
  Sequence apply(std::string_view op, const Sequence& a, const Sequence& b) const {
    return joined(op, a, b);
  }

 private:
  Sequence joined(std::string_view op, const Sequence& a, const Sequence& b) const {
    Sequence out;
    out.reserve(1 + a.size() + b.size());
    out.push_back(id(op));
    std::ranges::copy(a, std::back_inserter(out));
    std::ranges::copy(b, std::back_inserter(out));
    return out;
  }
  TokenId id(std::string_view name) const {
    for (std::size_t i = 0; i < library_.size(); ++i) {
      if (library_[static_cast<TokenId>(i)].name == name) return static_cast<TokenId>(i);
    }
    throw Error(ErrorKind::failed, fmt::format("the library has no token '{}'", name));
  }
  const TokenLibrary& library_;
};

// Velocity, its magnitude, its square and the load, as friction laws use them.
Sequence factor(const Writer& w, bool load, RandomStream& random) {
  const Sequence v = w.leaf("x1");
  const Sequence s = w.leaf("x2");
  switch (random.below(load ? 9 : 5)) {
    case 0:
      return v;
    case 1:
      return s;
    case 2:
      return w.apply("*", v, s);
    case 3:
      return w.apply("*", v, v);
    case 4:
      return w.apply("*", w.apply("*", v, v), s);
    case 5:
      return w.leaf("x3");
    case 6:
      return w.leaf("x4");
    case 7:
      return w.apply("*", w.leaf("x3"), w.leaf("x4"));
    default:
      return w.apply("*", s, w.apply("*", w.leaf("x3"), w.leaf("x4")));
  }
}

// A decaying or saturating shape: exp(-|v|), exp(-v^2), tanh(v), sqrt(|v|).
Sequence shape(const Writer& w, bool constants, RandomStream& random) {
  const Sequence v = w.leaf("x1");
  const Sequence magnitude = w.apply("*", v, w.leaf("x2"));
  Sequence argument = random.chance(0.5) ? magnitude : w.apply("*", v, v);
  if (constants) argument = w.apply("*", w.leaf("const"), argument);
  switch (random.below(4)) {
    case 0:
      return w.apply("tanh", argument);
    case 1:
      return w.apply("sqrt", argument);
    default:
      return w.apply("exp", argument);
  }
}

Sequence sum_of_terms(const Writer& w, bool load, bool constants, RandomStream& random) {
  Sequence sum;
  const std::uint64_t terms = 1 + random.below(4);
  for (std::uint64_t k = 0; k < terms; ++k) {
    Sequence term = factor(w, load, random);
    if (random.chance(0.3)) term = w.apply("*", term, shape(w, constants, random));
    if (constants && random.chance(0.5)) term = w.apply("*", w.leaf("const"), term);
    sum = sum.empty() ? term : w.apply(random.chance(0.7) ? "+" : "-", sum, term);
  }
  return sum;
}

// A polynomial alone, times a shape, or beside one.
Sequence with_linear(const Writer& w, bool load, RandomStream& random) {
  const Sequence linear = w.leaf("linear");
  switch (random.below(5)) {
    case 0:
      return linear;
    case 1:
      return w.apply("*", linear, shape(w, false, random));
    case 2:
      return w.apply("+", linear, shape(w, false, random));
    case 3:
      return w.apply("*", w.leaf("x2"), w.apply("exp", linear));
    default:
      return w.apply("+", linear, sum_of_terms(w, load, false, random));
  }
}

// Maximum likelihood of given sequences, by the policy and, where there is one, the encoder.
class Trainer {
 public:
  Trainer(Policy& policy, DataEncoder* encoder, const Prior& prior, double learning_rate)
      : policy_(policy),
        encoder_(encoder),
        prior_(prior),
        policy_adam_(policy.parameters().size(), learning_rate),
        encoder_adam_(DataEncoder::size(), learning_rate) {}

  void descend(std::span<const Sequence* const> sequences, double weight,
               const RandomStream& random) {
    const Examples examples = examples_of(sequences, weight, random);
    Eigen::VectorXd gradient;
    Eigen::MatrixXd starts;
    policy_.loss(examples.items, prior_, 1.0, gradient, &starts);
    policy_adam_.step(gradient, policy_.parameters());
    if (encoder_ == nullptr) return;
    Eigen::VectorXd encoder_gradient = Eigen::VectorXd::Zero(DataEncoder::size());
    for (std::size_t i = 0; i < examples.items.size(); ++i) {
      encoder_->add_gradient(examples.features[i], starts.col(static_cast<Eigen::Index>(i)),
                             encoder_gradient);
    }
    encoder_adam_.step(encoder_gradient, encoder_->parameters());
  }

  // Nats.
  double loss_per_token(const std::vector<Sequence>& sequences, const RandomStream& random) const {
    std::vector<const Sequence*> pointers;
    std::size_t tokens = 0;
    for (const Sequence& sequence : sequences) {
      pointers.push_back(&sequence);
      tokens += sequence.size();
    }
    Eigen::VectorXd unused;
    const double total =
        policy_.loss(examples_of(pointers, 1.0, random).items, prior_, 1.0, unused);
    return total / static_cast<double>(std::max<std::size_t>(1, tokens));
  }

 private:
  struct Examples {
    std::vector<WeightedSequence> items;
    std::vector<Eigen::MatrixXd> features;  // of the rows imagined for each; empty without encoder
    std::vector<Eigen::VectorXd> starts;    // what the items point to
  };

  Examples examples_of(std::span<const Sequence* const> sequences, double weight,
                       const RandomStream& random) const {
    Examples examples;
    for (std::size_t i = 0; i < sequences.size(); ++i) {
      examples.items.push_back({sequences[i], weight, 0.0});
      if (encoder_ == nullptr) continue;
      examples.features.push_back(
          imagined_features(policy_.library(), *sequences[i], random.split(i)));
      examples.starts.push_back(encoder_->encode(examples.features.back()));
    }
    for (std::size_t i = 0; i < examples.starts.size(); ++i) {
      examples.items[i].start = &examples.starts[i];
    }
    return examples;
  }

  Policy& policy_;
  DataEncoder* encoder_;
  const Prior& prior_;
  Adam policy_adam_;
  Adam encoder_adam_;
};

// A polynomial of degree three with about half of its terms.
Expression random_polynomial(std::size_t inputs, RandomStream& random) {
  const std::vector<int> caps(inputs, kLinearDegree);
  std::vector<Monomial> terms;
  std::vector<double> coefficients;
  for (Monomial& term : monomials(caps, kLinearDegree)) {
    if (random.chance(0.5)) continue;
    terms.push_back(std::move(term));
    coefficients.push_back(random.normal());
  }
  return terms.empty() ? Expression::constant(1) : polynomial(terms, coefficients);
}

Prior corpus_prior(const TokenLibrary& library) {
  PriorOptions options;
  options.domain_range = false;  // there are no data
  return {library, options, {std::vector<double>(kInputs, -1.0), -1, 1}};
}

}  // namespace

TokenLibrary pretraining_library() {
  std::vector<Op> operators = find_operator_set("full").operators();
  std::erase(operators, Op::atan);
  return {OperatorSet("pretraining", "of the shipped weights", std::move(operators)),
          kInputs,
          {.constants = true, .linear = true}};
}

Sequence friction_law(const TokenLibrary& library, RandomStream& random) {
  const Writer writer(library);
  const bool load = random.chance(0.5);
  if (random.chance(0.5)) return with_linear(writer, load, random);
  return sum_of_terms(writer, load, random.chance(0.7), random);
}

Eigen::MatrixXd imagined_features(const TokenLibrary& library, const Sequence& sequence,
                                  RandomStream random) {
  std::size_t inputs = 1;
  for (const TokenId id : sequence) {
    if (library[id].kind == TokenKind::input) {
      inputs = std::max<std::size_t>(inputs, library[id].input + 1U);
    }
  }
  Expression formula = to_expression(library, sequence, random_polynomial(inputs, random));
  for (const std::size_t place : constant_positions(formula)) {
    if (!is_exponent(formula, place)) {
      set_constant(formula, place, formula.node(place).value * random.normal());
    }
  }
  const bool signs = random.chance(0.75);
  std::vector<std::vector<double>> table(inputs, std::vector<double>(kImaginedRows));
  for (std::size_t j = 0; j < inputs; ++j) {
    for (std::size_t r = 0; r < kImaginedRows; ++r) {
      table[j][r] =
          signs && j % 2 == 1 ? (table[j - 1][r] < 0 ? -1.0 : 1.0) : random.uniform(-1, 1);
    }
  }
  std::vector<const double*> columns;
  for (const std::vector<double>& column : table) columns.push_back(column.data());
  std::vector<double> values(kImaginedRows);
  Evaluator().evaluate(formula, {columns, kImaginedRows}, values);
  // Rows that are not finite are left out, as they are of a problem's.
  std::size_t kept = 0;
  for (std::size_t r = 0; r < kImaginedRows; ++r) {
    if (!std::isfinite(values[r]) || std::abs(values[r]) > kLargestImagined) continue;
    for (std::vector<double>& column : table) column[kept] = column[r];
    values[kept++] = values[r] * (1 + 0.01 * random.normal());
  }
  if (kept < kImaginedRows / 2) return Eigen::MatrixXd(DataEncoder::kFeatures, 0);
  values.resize(kept);
  return DataEncoder::features({columns, kept}, values);
}

std::vector<Sequence> make_corpus(const TokenLibrary& library, const Prior& prior, int size,
                                  double friction_share, const RandomStream& random) {
  const auto laws = static_cast<std::size_t>(friction_share * size);
  std::vector<Sequence> corpus;
  RandomStream law_stream = random.split("laws");
  while (corpus.size() < laws) {
    Sequence law = friction_law(library, law_stream);
    if (prior.allows(law)) corpus.push_back(std::move(law));
  }
  // An untrained policy is the prior.
  const Policy untrained(library, random.split("untrained"));
  for (Sequence& sequence :
       untrained.sample(static_cast<std::size_t>(size) - laws, prior, random.split("library"))) {
    if (prior.allows(sequence)) corpus.push_back(std::move(sequence));
  }
  return corpus;
}

WeightsProvenance pretrain(Policy& policy, DataEncoder* encoder, const PretrainingOptions& options,
                           const std::function<void(double)>& progress) {
  const TokenLibrary& library = policy.library();
  const Prior prior = corpus_prior(library);
  const RandomStream random = RandomStream(key_of("pretrain")).split(options.seed);
  const std::vector<Sequence> corpus =
      make_corpus(library, prior, options.sequences, options.friction_share, random.split("train"));
  const std::vector<Sequence> held_out = make_corpus(
      library, prior, options.held_out, options.friction_share, random.split("held-out"));
  Trainer trainer(policy, encoder, prior, options.learning_rate);
  std::vector<std::size_t> order(corpus.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto batch = static_cast<std::size_t>(options.batch);
  for (int epoch = 0; epoch < options.epochs; ++epoch) {
    const auto epoch_key = static_cast<std::uint64_t>(epoch);
    RandomStream shuffling = random.split("epochs").split(epoch_key);
    shuffling.shuffle(std::span(order));
    for (std::size_t start = 0; start < order.size(); start += batch) {
      std::vector<const Sequence*> sequences;
      for (std::size_t i = start; i < std::min(order.size(), start + batch); ++i) {
        sequences.push_back(&corpus[order[i]]);
      }
      trainer.descend(sequences, 1.0 / options.batch,
                      random.split("rows").split(epoch_key).split(start));
      progress((epoch +
                static_cast<double>(start + sequences.size()) / static_cast<double>(order.size())) /
               options.epochs);
    }
  }
  return {
      fmt::format("tribench pretrain --seed {} --sequences {}{}{}", options.seed, options.sequences,
                  options.epochs == PretrainingOptions().epochs
                      ? ""
                      : fmt::format(" --epochs {}", options.epochs),
                  encoder == nullptr ? "" : " --encoder"),
      options.seed, corpus.size(), trainer.loss_per_token(held_out, random.split("held-out rows"))};
}

}  // namespace tribench::udsr
