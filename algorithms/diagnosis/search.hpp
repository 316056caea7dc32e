// SPDX-License-Identifier: MIT
//
// The search for missing effects on training movements: rounds of tests, additions by
// cross-validated gain, removals and the test for what is left over. Internal to the room.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "algorithms/diagnosis/diagnosis.hpp"
#include "algorithms/inference/cross_validation.hpp"
#include "algorithms/inference/score_test.hpp"
#include "algorithms/loop_model/loop_model.hpp"
#include "algorithms/loop_model/model_fit.hpp"
#include "algorithms/loop_model/smoothers.hpp"

namespace tribench::loop {

// A family excited in fewer clusters cannot reach a small p by sign flips (specification, 3.3).
inline constexpr std::size_t kFewestClusters = 20;
// Down to this many it may still be rescued by its gain: below, flips do not even reach kRescueP.
inline constexpr std::size_t kFewestToRescue = 10;
// Up to this p a family carried by few clusters may be rescued by its gain (specification, 6.4).
inline constexpr double kRescueP = 0.15;

// Worth less than this share of what is left, and of what the largest effect is worth: no more than
// the error of the other effects' shapes may be (docs/closed_loop.md).
inline constexpr double kSlight = 0.03;

// A model fitted to the training movements, in the coordinates of its own noise.
struct FittedModel {
  LoopModel model;
  Noise noise;
  Eigen::MatrixXd x;         // whitened tangent
  Eigen::MatrixXd basis;     // of x, orthonormal
  Eigen::VectorXd residual;  // whitened, orthogonal to the basis
  Eigen::VectorXd losses;    // held-out, by stretch
  Eigen::MatrixXd raw_tangent;
  Eigen::VectorXd raw_residual;
};

// The tests of all atoms against one fitted model.
struct Round {
  Eigen::MatrixXd columns;          // the library's, whitened with the model's noise
  std::vector<BlockScores> blocks;  // per atom
  std::vector<double> maxima;       // over all atoms, per flip
  std::vector<double> family_p;     // adjusted; 1 where untestable
  std::vector<double> family_score;
  std::vector<char> rescue_only;  // carried by fewer clusters than a test by flips needs
};

struct Candidate {
  std::size_t family = 0;
  std::size_t atom = 0;
  Gain gain;
  Eigen::VectorXd losses;
  bool rescued = false;  // carried by few clusters, admitted by its gain
};

class Search {
 public:
  Search(const Observations& train, const BaseModel& base,
         const std::vector<EffectFamily>& families, const DiagnosisOptions& options,
         const Clusters& clusters, RandomStream random);

  // Runs to the verdict; results below.
  void run();

  const FittedModel& base() const { return base_fit_; }
  const FittedModel& current() const { return current_; }
  const Clusters& clusters() const { return clusters_; }
  const std::vector<Atom>& library() const { return library_; }

  // What was found, family by family in the order picked.
  struct Found {
    std::size_t family;
    double p;
    Gain gain;
    bool few;
    std::vector<AliasFinding> aliases;
    bool another_shape = false;  // this cause, a curve that the library does not have
  };
  std::vector<Found> found;
  LeftoverFinding leftover;
  bool leftover_tested = false;
  std::vector<UntestableFinding> untestable;
  std::vector<CoincidingFamilies> aliased;
  AliasMap alias_map;
  std::vector<CandidateFinding> candidates;
  std::vector<std::string> notes;

  FittedModel fit(LoopModel model, FitScope scope) const;
  // Families whose p, gain or rescue admit them beside the present model, best gain first.
  std::vector<Candidate> admitted(const Round& round) const;
  Round test_all(const FittedModel& state) const;
  bool falls_with_speed(const LoopModel& model, std::size_t family) const;
  bool has_impossible_sign(const LoopModel& model) const;
  bool stands_for_another_cause(const LoopModel& model) const;
  void count_carriers(Round& round) const;

 private:
  void instantiate_library();
  void list_untestable(const Round& round);
  void list_coinciding(const Round& round);
  void map_aliases(const Eigen::MatrixXf& correlations, const Round& round);
  void list_candidates(const Round& round);
  double detectable(std::size_t family, const Round& round, double critical) const;
  bool add_best(const Round& round);
  bool add(const Candidate& winner, const Round& round);
  bool cancels_itself(const LoopModel& model, std::size_t family) const;
  void leave_out_cancelling();
  void note(std::string text);
  std::vector<AliasFinding> aliases_of(const Candidate& winner, const Round& round) const;
  double carriers(const Round& round, std::size_t atom, const FittedModel& state) const;
  bool differs_between_movements(std::size_t atom, const FittedModel& state) const;
  Eigen::VectorXd losses_with_own_offsets(std::size_t atom, const FittedModel& state) const;
  std::size_t best_shape(std::size_t atom, const Round& round, const FittedModel& state) const;
  std::optional<Candidate> rescue(std::size_t family, const Round& round,
                                  const FittedModel& state) const;
  // None where no atom of the family can be judged: none is testable, or the folds of the
  // cross-validation do not know its columns.
  std::optional<Candidate> best_atom(std::size_t family, const Round& round,
                                     const FittedModel& state) const;
  void reconsider();
  void drop_insignificant(std::size_t family);
  Gain lead_over_current(const FittedModel& other) const;
  double family_p_given_rest(std::size_t family, const FittedModel& rest, const Round& round,
                             const FittedModel& with) const;
  Eigen::VectorXd plain_losses(const LoopModel& model, const Eigen::MatrixXd& features = {},
                               double ridge = 0) const;
  std::vector<double> worths() const;
  double least_worth() const;
  double worth_beside(const Eigen::MatrixXd& columns, double ridge = 0) const;
  // Of a matrix with the library's columns, those of one atom.
  auto block_of(const Eigen::MatrixXd& columns, std::size_t atom) const {
    return columns.middleCols(static_cast<Eigen::Index>(blocks_[atom].first),
                              static_cast<Eigen::Index>(blocks_[atom].count));
  }
  Eigen::MatrixXd columns_of(std::size_t atom) const { return block_of(columns_, atom); }
  void leave_out_slight();
  // A found effect times another input.
  struct Modifier {
    std::size_t family;
    std::vector<std::string> signals;  // as the smoothers' pair
    Eigen::MatrixXd columns;
  };
  std::vector<Modifier> modifiers() const;
  BlockScores score_modifier(const Modifier& modifier) const;
  void test_leftover();
  void locate_leftover(const std::vector<Smoother>& smoothers,
                       const std::vector<Modifier>& products,
                       const std::vector<BlockScores>& blocks, const std::vector<double>& maxima);
  std::vector<std::string> inputs_of(std::size_t family) const;
  Gain gain_of(const std::vector<std::size_t>& families) const;
  Found* home_of(const std::vector<std::string>& inputs, std::size_t end, double nats);
  bool remembers(std::size_t family) const;
  void name_shapes();
  void drop_proxies(const Smoother& smoother);
  bool explains_more_than_is_left(const FittedModel& rest) const;
  static std::size_t atoms_of(std::size_t family, const LoopModel& model);
  void remove_family(LoopModel& model, std::size_t family) const;

  const Observations& data_;
  const std::vector<EffectFamily>& families_;
  const DiagnosisOptions& options_;
  const Clusters& clusters_;
  RandomStream random_;
  double noise_floor_ = 0;
  std::vector<Atom> library_;
  std::vector<char> usable_;   // per atom: testable given the base, in enough clusters
  Eigen::MatrixXd columns_;    // the library's raw columns, unit rms
  std::vector<Block> blocks_;  // per atom, in columns_
  Flips flips_;
  // Families that were added and did not stand beside the rest: not to be tried again.
  std::vector<std::size_t> rejected_;
  std::vector<std::size_t> asked_more_;  // families that would have taken a third column
  std::vector<std::size_t> one_column_;  // families whose second column came to cancel the first
  FittedModel base_fit_;
  FittedModel current_;
  // With all that was found, before the proxies of what it leaves over were dropped.
  struct WholeModel {
    FittedModel fit;
    double leftover_nats;
  };
  std::optional<WholeModel> whole_;
  double leftover_nats_ = 0;  // what a smoother in its inputs adds
};

}  // namespace tribench::loop
