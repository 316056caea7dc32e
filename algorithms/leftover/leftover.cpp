// SPDX-License-Identifier: MIT
#include "algorithms/leftover/leftover.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "algorithms/campaign/round.hpp"
#include "algorithms/campaign/worth.hpp"
#include "algorithms/inference/feature_scores.hpp"
#include "algorithms/leftover/local_defect.hpp"
#include "algorithms/leftover/serial_offsets.hpp"
#include "algorithms/leftover/unknown_ripple.hpp"
#include "algorithms/loop_model/smoothers.hpp"

namespace tribench::loop {
namespace {

constexpr double kSmootherRidge = 0.02;  // of the mean diagonal (specification, 3.8)
// Of what an effect adds: what adds less in the same inputs is its shape.
constexpr double kShapeShare = 0.1;
// Of the level of what is left over: half, beside the signals together.
constexpr double kShareOfOffsets = 0.5;

// Somewhere to look: a smooth function of one or two signals, or a found effect times another
// signal: what there is where the effect's size varies with it, far sharper than a smoother in
// both.
struct Place {
  std::vector<std::string> signals;
  const Smoother* smoother = nullptr;  // or a product
  Eigen::MatrixXd columns;             // of a product
  double ridge() const { return smoother != nullptr ? kSmootherRidge : 0; }
  bool is_product() const { return smoother == nullptr || signals.size() > 1; }
  Eigen::MatrixXd features(const Observations& data) const {
    return smoother != nullptr ? with_direction(*smoother, data) : columns;
  }
};

// The signals that a family's columns are functions of, signs left out. What has a memory of the
// motion is a function of all of it: near a reversal the path since, the speed, the acceleration
// and, where movements begin there, the time tell the same. Oil warms ahead of its thermometer from
// the start of a movement on.
std::vector<std::string> inputs_of(std::size_t family, const LoopModel& model,
                                   const Observations& data) {
  std::set<std::string> names;
  for (const Signal* signal : signals_read(model, family, data)) {
    for (const std::string_view name : {std::string_view("v"), std::string_view("a"),
                                        std::string_view("d"), Signal::kSinceStart}) {
      if (signal->has_memory() && data.find(name) != nullptr) names.emplace(name);
    }
    if (signal->role == Role::temperature && data.find(Signal::kSinceStart) != nullptr) {
      names.emplace(Signal::kSinceStart);
    }
    const bool is_told = signal->has_memory() || signal->name.starts_with("sgn_");
    if (!is_told) names.insert(signal->name);
  }
  return {names.begin(), names.end()};
}

class LeftoverSearch {
 public:
  LeftoverSearch(SearchState& state, const Campaign& campaign, RandomStream random)
      : state_(state),
        campaign_(campaign),
        random_(random),
        smoothers_(make_smoothers(campaign.data, random)) {}

  const LeftoverFinding& finding() const { return leftover_; }

  void test_residual();
  void look_for_waves();
  void look_for_defect();
  void look_for_serial_offsets();
  void name_shapes();
  void name_what_asks_for_more();

 private:
  std::vector<Place> places() const;
  std::vector<Place> products_of(std::size_t family) const;
  BlockScores score_product(const Eigen::MatrixXd& columns) const;
  struct Home {
    const Place* place;
    double nats;  // what it adds
  };
  bool beats_its_sum(const Place& product, const Eigen::VectorXd& losses) const;
  std::optional<Home> best_place(const std::vector<Place>& places,
                                 const std::vector<BlockScores>& blocks,
                                 const std::vector<double>& maxima) const;
  std::vector<std::size_t> families_along_the_position() const;
  bool is_next_to_nothing(double worth);
  void locate(const Home& home);
  void drop_proxies(const Smoother& smoother);
  bool drop_if_superfluous(const Smoother& smoother, std::size_t family, bool excused,
                           LoopModel& model);
  bool explains_more_than_is_left(const FittedModel& rest) const;
  bool remembers(std::size_t family) const;
  bool absorbs_a_defect(std::size_t family) const;
  Found* home_of(const std::vector<std::string>& inputs, std::size_t end, double nats);

  const FittedModel& model() const { return state_.model; }

  SearchState& state_;
  const Campaign& campaign_;
  RandomStream random_;
  std::vector<Smoother> smoothers_;
  LeftoverFinding leftover_;
  // With all that was found, before the proxies of what it leaves over were dropped.
  struct WholeModel {
    FittedModel fit;
    double leftover_nats;
  };
  std::optional<WholeModel> whole_;
};

std::vector<Place> LeftoverSearch::products_of(std::size_t family) const {
  std::set<std::string> lives_in;
  for (const Signal* signal : signals_read(model().model, family, campaign_.data)) {
    if (signal->role != Role::velocity_sign) lives_in.insert(signal->name);
  }
  std::vector<Place> all;
  if (lives_in.size() != 1) return all;
  std::vector<Expression> formulas;
  for (const Atom& atom : model().model.atoms) {
    if (atom.family != family) continue;
    formulas.insert(formulas.end(), atom.columns.begin(), atom.columns.end());
  }
  for (const SignalPair& pair : smoothed_pairs()) {
    const bool first = *lives_in.begin() == pair[0];
    if (!first && *lives_in.begin() != pair[1]) continue;
    const Eigen::VectorXd other = unit_signal(campaign_.data, pair[first ? 1 : 0]);
    if (other.size() == 0) continue;
    all.push_back({{std::string(pair[0]), std::string(pair[1])},
                   nullptr,
                   other.asDiagonal() * evaluate_columns(formulas, campaign_.data)});
  }
  return all;
}

std::vector<Place> LeftoverSearch::places() const {
  std::vector<Place> all;
  for (const Smoother& smoother : smoothers_) all.push_back({smoother.signals, &smoother, {}});
  for (const Found& one : state_.found) {
    for (Place& product : products_of(one.family)) all.push_back(std::move(product));
  }
  return all;
}

BlockScores LeftoverSearch::score_product(const Eigen::MatrixXd& columns) const {
  const Eigen::MatrixXd z = whitened(columns, campaign_.clusters, model().noise);
  BlockScores block = score_block(z, model().basis, model().residual, campaign_.clusters);
  if (block.test.carrying < kFewestClusters) block.test.testable = false;
  return block;
}

void LeftoverSearch::test_residual() {
  const std::size_t stretches = campaign_.clusters.stretches.size();
  if (stretches < kFewestClusters) {
    state_.note(fmt::format(
        "{} stretches of movement are too few to tell whether anything is left over; {} "
        "are needed",
        stretches, kFewestClusters));
    return;
  }
  leftover_.tested = true;
  const std::vector<Place> looked_at = places();
  const FeatureScorer scorer(model().basis, model().residual, campaign_.clusters, model().noise,
                             direction_of(campaign_.data));
  std::vector<BlockScores> blocks;
  double largest = 0;
  for (const Place& place : looked_at) {
    blocks.push_back(place.smoother != nullptr
                         ? scorer.score(place.smoother->features, kSmootherRidge)
                         : score_product(place.columns));
    largest = std::max(largest, blocks.back().test.score);
  }
  const double alpha = campaign_.options.alpha_leftover;
  // Once so many flips have exceeded it the p-value cannot come below alpha any more.
  const auto stop =
      static_cast<std::size_t>(std::ceil(alpha * static_cast<double>(campaign_.options.flips + 1)));
  const std::vector<double> maxima = flip_maxima(blocks, campaign_.flips, largest, stop);
  leftover_.p = adjusted_p(largest, maxima);
  if (leftover_.p > alpha) return;
  if (const std::optional<Home> home = best_place(looked_at, blocks, maxima)) locate(*home);
}

// Whether a product predicts clearly better than a function of its one input and one of its other,
// as smooth as it is itself: what is smoother than the rest predicts better where the truth is.
bool LeftoverSearch::beats_its_sum(const Place& product, const Eigen::VectorXd& losses) const {
  Eigen::MatrixXd sum(campaign_.data.rows(), 0);
  for (const std::string& signal : product.signals) {
    sum = beside(sum, with_direction(smooth_single(campaign_.data, signal), campaign_.data));
  }
  const Eigen::MatrixXd features = whitened(sum, campaign_.clusters, model().noise);
  const Eigen::VectorXd of_sum = losses_beside(model(), features, campaign_, kSmootherRidge);
  const Gain lead = paired_gain(of_sum, losses);
  return lead.nats > lead.error;
}

// Where it lives: what predicts best; a product only if it beats every single input and both of its
// own together. None where no place is significant by itself.
std::optional<LeftoverSearch::Home> LeftoverSearch::best_place(
    const std::vector<Place>& places, const std::vector<BlockScores>& blocks,
    const std::vector<double>& maxima) const {
  std::optional<Home> best;
  Eigen::VectorXd best_losses;
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (adjusted_p(blocks[k].test.score, maxima) > campaign_.options.alpha_leftover) continue;
    const Eigen::MatrixXd features =
        whitened(places[k].features(campaign_.data), campaign_.clusters, model().noise);
    const Eigen::VectorXd losses = losses_beside(model(), features, campaign_, places[k].ridge());
    const Gain gain = paired_gain(model().losses, losses);
    if (std::isnan(gain.nats)) continue;
    if (best) {
      const Gain lead = paired_gain(best_losses, losses);
      const bool clearly = lead.nats > (places[k].is_product() ? lead.error : 0.0);
      if (!(gain.nats > best->nats && clearly)) continue;
    }
    if (places[k].signals.size() > 1 && !beats_its_sum(places[k], losses)) continue;
    best = Home{&places[k], gain.nats};
    best_losses = losses;
  }
  return best;
}

// Less of the squared error than what is left over has to be worth.
bool LeftoverSearch::is_next_to_nothing(double worth) {
  return worth < least_worth_of_leftover(model().model, state_.families(), campaign_);
}

void LeftoverSearch::locate(const Home& home) {
  const double worth =
      worth_of(home.place->features(campaign_.data), model().model, campaign_, home.place->ridge());
  if (is_next_to_nothing(worth)) {
    state_.note("what is left over is next to nothing");
    return;
  }
  leftover_.gain = home.nats;
  leftover_.signals = home.place->signals;
  leftover_.inputs.clear();
  for (const std::string& signal : leftover_.signals) {
    leftover_.inputs.push_back(input_name(campaign_.data, signal));
  }
  if (!whole_) whole_ = WholeModel{model(), home.nats};
  const std::size_t before = state_.found.size();
  const auto smoother = std::ranges::find(smoothers_, leftover_.signals, &Smoother::signals);
  if (smoother != smoothers_.end() && campaign_.options.has("proxies")) drop_proxies(*smoother);
  if (state_.found.size() == before) return;
  // Without its proxies the leftover shows better where it lives.
  const LeftoverFinding known = leftover_;
  test_residual();
  if (leftover_.inputs.empty()) {
    leftover_.inputs = known.inputs;
    leftover_.signals = known.signals;
  }
}

// A smoother of the position sees no wave that is shorter than the distance of its centres. What is
// left of a ripple that was found is its shape.
void LeftoverSearch::look_for_waves() {
  if (!leftover_.tested || !campaign_.options.has("unknown_ripple")) return;
  const std::optional<Wave> wave = unknown_ripple(model(), campaign_, random_.split("waves"));
  if (!wave) return;
  const Eigen::MatrixXd columns = wave_columns(*wave, campaign_.data);
  const double worth = worth_of(columns, model().model, campaign_, 0);
  if (is_next_to_nothing(worth)) return;
  const auto rows = static_cast<double>(campaign_.data.rows());
  leftover_.repeating = {wave->wavenumber, worth * model().raw_residual.squaredNorm() / rows};
  const bool is_named = std::ranges::any_of(state_.families(), [&](std::size_t family) {
    return repeats_with_the_gear(campaign_.families[family]);
  });
  if (is_named || !leftover_.inputs.empty()) return;
  leftover_.p = wave->p;
  leftover_.signals = {"q"};
  leftover_.inputs = {input_name(campaign_.data, "q")};
  const Eigen::MatrixXd z = whitened(columns, campaign_.clusters, model().noise);
  leftover_.gain = paired_gain(model().losses, losses_beside(model(), z, campaign_)).nats;
}

// But for learned ones: those may be of one place themselves.
std::vector<std::size_t> LeftoverSearch::families_along_the_position() const {
  std::vector<std::size_t> families;
  for (const std::size_t family : state_.families()) {
    const auto inputs = inputs_of(family, model().model, campaign_.data);
    const bool is_learned =
        std::ranges::count(campaign_.options.learned, campaign_.families[family].name,
                           &EffectFamily::name) > 0;
    if (inputs == std::vector<std::string>{"q"} && !is_learned) families.push_back(family);
  }
  return families;
}

// What stands for a bump at one place is no effect: without it the bump is what is left over.
void LeftoverSearch::look_for_defect() {
  if (!leftover_.tested || !campaign_.options.has("local_defect")) return;
  const std::vector<std::size_t> families = families_along_the_position();
  if (families.empty()) return;
  const std::optional<double> gain = gain_as_a_defect(families, model(), campaign_);
  if (!gain) return;
  LoopModel rest = model().model;
  for (const std::size_t family : families) {
    leftover_.proxies_removed.push_back(campaign_.families[family].name);
    std::erase_if(state_.found, [&](const Found& one) { return one.family == family; });
    rest = rest.without(family);
  }
  state_.model = fit_in_its_noise(std::move(rest), campaign_, FitScope::everything);
  test_residual();
  leftover_.gain = *gain;
  leftover_.signals = {"q"};
  leftover_.inputs = {input_name(campaign_.data, "q")};
}

// In no signal, and in the order of the movements all the same: it is in what changes with time.
void LeftoverSearch::look_for_serial_offsets() {
  const bool is_asked =
      leftover_.tested && leftover_.inputs.empty() && campaign_.options.has("serial_offsets");
  if (!is_asked) return;
  const auto p = serial_offsets_p(model(), campaign_, random_.split("offsets"));
  if (!p || *p > kShareOfOffsets * campaign_.options.alpha_leftover) return;
  const Eigen::MatrixXd columns = time_of_movements(campaign_);
  if (is_next_to_nothing(worth_of(columns, model().model, campaign_, kSmootherRidge))) return;
  leftover_.p = *p;
  leftover_.signals = {"t"};
  leftover_.inputs = {input_name(campaign_.data, "t")};
  const Eigen::MatrixXd z = whitened(columns, campaign_.clusters, model().noise);
  leftover_.gain =
      paired_gain(model().losses, losses_beside(model(), z, campaign_, kSmootherRidge)).nats;
}

// Whether the leftover's smoother makes a family superfluous; then the model loses it.
bool LeftoverSearch::drop_if_superfluous(const Smoother& smoother, std::size_t family, bool excused,
                                         LoopModel& model) {
  FittedModel rest = fit_in_its_noise(model.without(family), campaign_, FitScope::linear);
  if (excused && explains_more_than_is_left(rest)) return false;
  const Eigen::MatrixXd features =
      whitened(with_direction(smoother, campaign_.data), campaign_.clusters, rest.noise);
  rest.basis = orthonormal_basis(beside(rest.x, features));
  rest.residual = project_off(rest.residual, rest.basis);
  if (tells_beside(rest, family, this->model(), campaign_)) return false;
  leftover_.proxies_removed.push_back(campaign_.families[family].name);
  std::erase_if(state_.found, [&](const Found& one) { return one.family == family; });
  model = model.without(family);
  return true;
}

// Whether a family asked for more columns than an effect has, as many harmonics absorb a defect at
// one place (specification, 11.6). A curve of the speed or of what the motion was before that asks
// for more is that curve in another shape.
bool LeftoverSearch::absorbs_a_defect(std::size_t family) const {
  if (std::ranges::count(state_.asked_more, family) == 0) return false;
  const std::vector<std::string> inputs = inputs_of(family, model().model, campaign_.data);
  return inputs != std::vector<std::string>{"v"} && !remembers(family);
}

// A family that the leftover's smoother makes superfluous is a proxy of what is left over, unless
// it explains more than that: the smoother in v takes the place of any effect of v, the true one
// too. What is left over is what the whole model leaves, and its proxies have to explain less
// together: each one dropped leaves more for the smoother, which would make the next one look
// superfluous. A family that absorbs a defect is not excused.
void LeftoverSearch::drop_proxies(const Smoother& smoother) {
  LoopModel model = this->model().model;
  bool dropped = false;
  for (const bool excused : {false, true}) {
    for (const std::size_t family : state_.families()) {
      if (absorbs_a_defect(family) == excused) continue;
      dropped = drop_if_superfluous(smoother, family, excused, model) || dropped;
    }
    if (!excused && dropped) {
      whole_->fit = fit_in_its_noise(model, campaign_, FitScope::everything);
    }
  }
  if (dropped) state_.model = fit_in_its_noise(std::move(model), campaign_, FitScope::everything);
}

// What the whole model has and `rest` has not, against what the whole model leaves over.
bool LeftoverSearch::explains_more_than_is_left(const FittedModel& rest) const {
  const Gain lead = lead_over(whole_->fit, rest, campaign_);
  return -lead.nats > whole_->leftover_nats && -lead.nats > lead.error;
}

bool LeftoverSearch::remembers(std::size_t family) const {
  const std::vector<std::string> inputs = inputs_of(family, model().model, campaign_.data);
  return std::ranges::any_of(
      inputs, [&](const std::string& name) { return campaign_.data.find(name)->has_memory(); });
}

// The effect found before the one at `end` that has all of these inputs, the first of them; none
// where all that have them add no more than `nats` together: which of them would be at home there
// matters less than what lives there at all.
Found* LeftoverSearch::home_of(const std::vector<std::string>& inputs, std::size_t end,
                               double nats) {
  Found* home = nullptr;
  std::vector<std::size_t> families;
  for (std::size_t k = 0; k < end; ++k) {
    Found& one = state_.found[k];
    if (!std::ranges::includes(inputs_of(one.family, model().model, campaign_.data), inputs)) {
      continue;
    }
    if (home == nullptr) home = &one;
    families.push_back(one.family);
  }
  return home != nullptr && gain_of(families, model(), campaign_).nats > nats ? home : nullptr;
}

// No curve of the library is the true one to the last nat. What lives in nothing but the inputs of
// a larger effect is that effect in another shape: what is left over is no UNKNOWN beside the right
// name, and where that effect remembers the motion, one that came after it and adds far less gives
// it its columns.
void LeftoverSearch::name_shapes() {
  std::vector<Found>& found = state_.found;
  const bool takes_small_ones = campaign_.options.has("shape_of_memory");
  for (std::size_t k = takes_small_ones ? found.size() : 0; k-- > 1;) {
    const std::size_t family = found[k].family;
    const std::vector<std::string> inputs = inputs_of(family, model().model, campaign_.data);
    const double nats = gain_of({family}, model(), campaign_).nats / kShapeShare;
    Found* home = inputs.empty() ? nullptr : home_of(inputs, k, nats);
    if (home == nullptr || !remembers(home->family)) continue;
    home->another_shape = true;
    state_.note(fmt::format(
        "'{}' only shapes '{}': in the same inputs more than {:.0f} times as much is "
        "explained without it",
        campaign_.families[family].name, campaign_.families[home->family].name, 1 / kShapeShare));
    for (Atom& atom : state_.model.model.atoms) {
      if (atom.family == family) atom.family = home->family;
    }
    found.erase(found.begin() + static_cast<std::ptrdiff_t>(k));
  }
  if (leftover_.inputs.empty() || !campaign_.options.has("shape_of_leftover")) return;
  std::vector<std::string> inputs = leftover_.signals;
  std::ranges::sort(inputs);
  Found* home = home_of(inputs, found.size(), leftover_.gain);
  if (home == nullptr) return;
  home->another_shape = true;
  leftover_.inputs.clear();
}

// A family that was asked for more columns than an effect has is that cause in another shape, or
// something else that these columns can tell piece by piece.
void LeftoverSearch::name_what_asks_for_more() {
  for (Found& one : state_.found) {
    if (std::ranges::count(state_.asked_more, one.family) == 0) continue;
    if (absorbs_a_defect(one.family)) {
      state_.note(fmt::format(
          "more columns of '{}' are asked for than an effect has: a sign of something that only "
          "looks like it",
          campaign_.families[one.family].name));
    } else {
      one.another_shape = true;
    }
  }
}

}  // namespace

LeftoverFinding find_leftover(SearchState& state, const Campaign& campaign, RandomStream random) {
  LeftoverSearch search(state, campaign, random);
  search.test_residual();
  search.look_for_defect();
  search.look_for_waves();
  search.look_for_serial_offsets();
  search.name_shapes();
  search.name_what_asks_for_more();
  return search.finding();
}

}  // namespace tribench::loop
