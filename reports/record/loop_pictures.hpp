// SPDX-License-Identifier: MIT
//
// The series behind a closed loop's pictures: means of many rows in bins along one coordinate, so
// that nothing lies over anything else and a page has the same size for a thousand rows and for a
// million. Words and colours are the report's.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace tribench {

// What is drawn along an axis.
struct LoopAxis {
  std::string channel;  // role name, "distance_since_reversal", or a formula over symbols
  std::string unit;
  bool magnitude = false;  // its size without its sign
  double period = 0;       // folded over so much of it; 0: not folded
};

// Which rows a series is made of.
enum class LoopSplit {
  all,
  forward,
  backward,
  speeding_up,
  slowing_down,
  driving,
  back_driving,
  load_level
};

// Means over bins of rows; all vectors have one length, NaN where there is no figure.
struct LoopSeries {
  LoopSplit split = LoopSplit::all;
  double level = 0;              // of load_level: the mean load
  std::vector<double> x;         // mean of the rows' coordinate
  std::vector<double> measured;  // friction, partial residual, or residual of the new model
  std::vector<double> spread;    // see the picture it belongs to
  std::vector<double> before;    // what the base says (friction), its residual (inputs)
  std::vector<double> after;     // what the new model says; the fitted effect
  std::vector<double> band;      // half width of the effect's 95 % band
  std::vector<double> rows;
};

// Measured friction against velocity with both models, means of the same rows; spread is one
// standard deviation of rows. The rigid body's part of the new model is taken off all three.
struct LoopFrictionPicture {
  LoopAxis x;
  bool rigid_part_removed = false;
  std::vector<LoopSeries> series;  // a direction and load level each
};

// What the rows say of one effect once everything else of the model is taken off (measured), the
// fitted effect (after) and its band. spread: half of the 95 % interval of the mean.
struct LoopEffectPicture {
  std::string family;
  LoopAxis x;
  // The torque against the motion (positive: it brakes) in place of the torque itself.
  bool against_motion = false;
  std::vector<LoopSeries> series;
  std::vector<double> marks;  // where movements begin, of a picture over the campaign
};

// Residuals of the base (before) and the new model (measured) against one input; spread as above.
struct LoopInputPicture {
  LoopAxis x;
  bool leftover = false;  // what is left over lives here
  std::vector<LoopSeries> series;
};

// Mean residual of the new model over two inputs, cell by cell.
struct LoopMapPicture {
  LoopAxis x;
  LoopAxis y;
  struct Cell {
    double x0, x1, y0, y1;
    double value;
    std::size_t rows;
  };
  std::vector<Cell> cells;
};

// A movement as it was measured and as both models have it.
struct LoopTrace {
  std::string movement;
  std::string why;        // "middle", "most", "least": its rank by the fall of its error
  bool held_out = false;  // took no part in the fit
  bool has_time = true;   // else x counts rows
  std::vector<double> x;
  std::vector<double> measured;
  std::vector<double> before;
  std::vector<double> after;
};

struct LoopMovementPoint {
  std::string name;
  bool held_out = false;
  double before = 0;
  double after = 0;
};

// Largest correlation of two families' columns in these data, the base removed.
struct LoopAliasMap {
  std::vector<std::string> families;
  std::vector<std::vector<double>> correlation;
};

// Rows, thinned evenly: kept for programs that read loop.json.
struct LoopResidualRows {
  std::vector<double> before;
  std::vector<double> after;
  std::vector<double> effect;
  struct Effect {
    std::string family;
    std::vector<double> y;
  };
  std::vector<Effect> effects;
  struct Channel {
    std::string name;
    std::string unit;
    std::vector<double> x;
  };
  std::vector<Channel> channels;
};

struct LoopPictures {
  LoopFrictionPicture friction;
  std::vector<LoopEffectPicture> effects;
  std::vector<LoopInputPicture> inputs;
  std::vector<LoopMapPicture> maps;  // of what is left over in two inputs
  std::vector<LoopTrace> traces;
  std::vector<LoopMovementPoint> movements;
  LoopAliasMap aliases;
  LoopResidualRows residuals;
};

}  // namespace tribench
