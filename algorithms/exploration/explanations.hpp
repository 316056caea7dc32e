// SPDX-License-Identifier: MIT
//
// What friction may have beside its base: the families of the library and, for each signal or pair
// of signals, "something else that lives there". A family is one of several blocks of columns; a
// block is scaled so that a coefficient of 1 is an effect as large as the noise over the reference
// campaign (foresight.hpp).
//
// No joint has just the library's shapes. Beside its block a family of the library has columns for
// its own misfit: what its shapes become where their size varies smoothly with the family's own
// signals, the few directions of most variance over the reference. Where the family's shapes vanish
// (a lag at constant speed, a ripple's mean over a turn) they vanish too, so that a misfit is no
// reason to name another family. What it has of the block's own shapes over the reference is the
// effect and no misfit. A sensor of temperature is late, too: what lives in a temperature may live
// in where it is going, the base times the rate of the reading (the signal kWarming, where the
// reference has it), and has a room of its own for that.
//
// Columns of a row depend on its movement and the reference alone.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "algorithms/effects/effect_library.hpp"
#include "algorithms/exploration/smooth_columns.hpp"
#include "algorithms/inference/evidence.hpp"
#include "algorithms/loop_model/loop_model.hpp"
#include "problems/preparation/observations.hpp"

namespace tribench::loop {

// Of interest, where nobody says otherwise: root mean square over the reference, in the noise's.
inline constexpr double kSmallestEffect = 0.5;

struct ExplainingFamily {
  std::string name;                 // "stribeck", "unknown:position", "unknown:velocity x position"
  bool unknown = false;             // of no library: its name is where it lives
  std::vector<std::string> inputs;  // role names
  // Of a family of the library: those that tell it from others. Speed only carries an effect of
  // anything else.
  std::vector<std::string> characteristic;
  std::vector<EffectBlock> blocks;  // the same columns in several sizes, each with the misfit
};

class ExplanationSpace {
 public:
  // reference: every signal that can vary does. gear_ratios as of DiagnosisOptions.
  // smallest_effect: of interest, > 0; what is smaller is neither named nor ruled out.
  ExplanationSpace(const Observations& reference, const std::vector<double>& gear_ratios,
                   double smallest_effect = kSmallestEffect);

  const std::vector<ExplainingFamily>& families() const { return families_; }
  const std::vector<std::string>& untestable() const { return untestable_; }
  const Observations& reference() const { return reference_; }

  // The scaled columns on rows with the reference's signals: rows x columns.
  Eigen::MatrixXd columns(const Observations& rows) const;
  Eigen::MatrixXd base_columns(const Observations& rows) const;

  // Of the block's friction against speed, with the base's: what tells it from one of another
  // family that draws the same.
  SpeedCurve curve_of(const EffectBlock& block) const;

  // Rows of the reference at its speeds in either direction, and their columns.
  struct Speeds {
    std::vector<double> v;
    Eigen::MatrixXd base;
    Eigen::MatrixXd columns;
  };
  const Speeds& speeds() const { return speeds_; }

 private:
  // Where something else may live; one axis or two.
  struct Place {
    std::vector<SignalAxis> axes;
    std::vector<Eigen::Index> centres;
  };
  // A family's shapes times smooth functions of its signals, folded into few columns.
  struct Misfit {
    Eigen::Index first = 0;  // of the formulas
    Eigen::Index count = 0;
    std::vector<SignalAxis> axes;
    bool late = false;     // lives in a temperature
    Eigen::MatrixXd fold;  // shapes x (1 + centres) -> columns
  };
  // What lives in a temperature that the sensor will show later.
  struct LateSensor {
    SignalAxis axis;           // the temperature
    Eigen::RowVectorXd scale;  // of the base times the warming
    Eigen::MatrixXd fold;      // of these times (1 + centres) -> columns
  };

  void add_library(const std::vector<double>& gear_ratios);
  void add_places();
  void settle_scale();
  void add_misfits();
  void add_late_sensor();
  void leave_to_the_library(const Eigen::MatrixXd& all);
  void measure_blocks(double smallest_effect);
  void settle_speeds();
  Eigen::MatrixXd shaped(const Misfit& misfit, const Observations& rows,
                         const Eigen::MatrixXd& formulas) const;
  Eigen::MatrixXd late_columns(const Observations& rows) const;
  Eigen::MatrixXd fold_of(const Eigen::MatrixXd& all, double size) const;
  // Unscaled; without the misfits' columns.
  Eigen::MatrixXd raw_columns(const Observations& rows) const;
  Eigen::MatrixXd place_columns(const Place& place, const Observations& rows) const;

  Observations reference_;
  std::vector<ExplainingFamily> families_;
  std::vector<std::string> untestable_;
  std::vector<Expression> formulas_;
  std::vector<SpeedCurve> curves_;  // of each formula
  std::vector<Place> places_;
  std::vector<Misfit> misfits_;
  std::optional<LateSensor> late_sensor_;
  Speeds speeds_;
  Eigen::VectorXd scale_;  // of the formulas, the places, then misfits and late sensor (1)
};

}  // namespace tribench::loop
