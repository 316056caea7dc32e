// SPDX-License-Identifier: MIT
#include "algorithms/udsr/pretraining.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string_view>

#include "foundation/error.hpp"

namespace tribench::udsr {
namespace {

constexpr std::size_t kInputs = 8;

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

double held_out_loss(const Policy& policy, const Prior& prior,
                     const std::vector<Sequence>& corpus) {
  std::vector<const Sequence*> pointers;
  std::size_t tokens = 0;
  for (const Sequence& sequence : corpus) {
    pointers.push_back(&sequence);
    tokens += sequence.size();
  }
  double total = 0;
  for (const double log_p : policy.log_probabilities(pointers, prior)) total -= log_p;
  return total / static_cast<double>(std::max<std::size_t>(1, tokens));
}

Prior corpus_prior(const TokenLibrary& library) {
  PriorOptions options;
  options.domain_range = false;  // there are no data
  return {library, options, {std::vector<double>(kInputs, -1.0), -1, 1}};
}

}  // namespace

TokenLibrary pretraining_library() {
  return {find_operator_set("full"), kInputs, {.constants = true, .linear = true}};
}

Sequence friction_law(const TokenLibrary& library, RandomStream& random) {
  const Writer writer(library);
  const bool load = random.chance(0.5);
  if (random.chance(0.5)) return with_linear(writer, load, random);
  return sum_of_terms(writer, load, random.chance(0.7), random);
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

WeightsProvenance pretrain(Policy& policy, const PretrainingOptions& options,
                           const std::function<void(double)>& progress) {
  const TokenLibrary& library = policy.library();
  const Prior prior = corpus_prior(library);
  const RandomStream random = RandomStream(key_of("pretrain")).split(options.seed);
  const std::vector<Sequence> corpus =
      make_corpus(library, prior, options.sequences, options.friction_share, random.split("train"));
  const std::vector<Sequence> held_out = make_corpus(
      library, prior, options.held_out, options.friction_share, random.split("held-out"));
  Adam adam(policy.parameters().size(), options.learning_rate);
  std::vector<std::size_t> order(corpus.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto batch = static_cast<std::size_t>(options.batch);
  for (int epoch = 0; epoch < options.epochs; ++epoch) {
    RandomStream shuffling = random.split("epochs").split(static_cast<std::uint64_t>(epoch));
    shuffling.shuffle(std::span(order));
    for (std::size_t start = 0; start < order.size(); start += batch) {
      std::vector<WeightedSequence> items;
      for (std::size_t i = start; i < std::min(order.size(), start + batch); ++i) {
        items.push_back({&corpus[order[i]], 1.0 / options.batch, 0.0});
      }
      Eigen::VectorXd gradient;
      policy.loss(items, prior, 1.0, gradient);
      adam.step(gradient, policy.parameters());
      progress(
          (epoch + static_cast<double>(start + items.size()) / static_cast<double>(order.size())) /
          options.epochs);
    }
  }
  return {
      fmt::format("tribench pretrain --seed {} --sequences {}{}", options.seed, options.sequences,
                  options.epochs == PretrainingOptions().epochs
                      ? ""
                      : fmt::format(" --epochs {}", options.epochs)),
      options.seed, corpus.size(), held_out_loss(policy, prior, held_out)};
}

}  // namespace tribench::udsr
