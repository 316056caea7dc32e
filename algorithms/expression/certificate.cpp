// SPDX-License-Identifier: MIT
//
// Writing certificates: cutting the box until the checker's own bounds suffice.
#include "algorithms/expression/certificate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "algorithms/expression/text.hpp"

namespace tribench {
namespace {

using Json = nlohmann::ordered_json;

class Writer {
 public:
  Writer(const Expression& formula, const NamedBox& box, std::size_t max_pieces)
      : formula_(formula), box_(box), max_pieces_(max_pieces) {
    for (const Node& node : formula.nodes()) {
      if (node.is_variable()) columns_.push_back(node.variable);
    }
    std::sort(columns_.begin(), columns_.end());
    columns_.erase(std::unique(columns_.begin(), columns_.end()), columns_.end());
  }

  // False where the pieces do not suffice.
  bool cover(const Piece& piece) {
    if (entries_.size() >= max_pieces_) return false;
    if (const auto bounds = piece_bounds(formula_, piece)) {
      close(piece, *bounds);
      return true;
    }
    const auto cut = choose_cut(piece);
    if (!cut) return false;
    entries_.push_back({{"cut", {box_.names[cut->first], cut->second}}});
    Piece lower = piece;
    Piece upper = piece;
    lower[cut->first].high = cut->second;
    upper[cut->first].low = cut->second;
    return cover(lower) && cover(upper);
  }
  Json take_entries() { return std::move(entries_); }

 private:
  void close(const Piece& piece, const PieceRange& bounds) {
    Json sides = Json::object();
    for (std::size_t j = 0; j < piece.size(); ++j) {
      sides[box_.names[j]] = {piece[j].low, piece[j].high};
    }
    entries_.push_back({{"piece", sides}, {"bounds", {bounds.low, bounds.high}}});
  }

  static double middle_of(const PieceRange& side) {
    // Across zero at zero, across magnitudes at the geometric mean.
    if (side.low < 0 && side.high > 0) return 0;
    const double small = std::min(std::abs(side.low), std::abs(side.high));
    const double large = std::max(std::abs(side.low), std::abs(side.high));
    if (small > 0 && large / small > 1e6) {
      return std::copysign(std::sqrt(small) * std::sqrt(large), side.high + side.low);
    }
    return side.low / 2 + side.high / 2;
  }

  // Tries a cut along each input and takes the one whose halves are bounded in more nodes.
  std::optional<std::pair<std::size_t, double>> choose_cut(const Piece& piece) const {
    std::optional<std::pair<std::size_t, double>> best;
    std::size_t most = 0;
    double widest = -1;
    for (const std::size_t j : columns_) {
      const double middle = middle_of(piece[j]);
      if (!(piece[j].low < middle && middle < piece[j].high)) continue;
      const std::size_t nodes = bounded_nodes(piece, j, middle);
      const double width =
          (piece[j].high - piece[j].low) / (box_.ranges[j].high - box_.ranges[j].low);
      if (best && (nodes < most || (nodes == most && width <= widest))) continue;
      best = {j, middle};
      most = nodes;
      widest = width;
    }
    return best;
  }

  std::size_t bounded_nodes(const Piece& piece, std::size_t axis, double middle) const {
    Piece half = piece;
    half[axis].high = middle;
    std::size_t nodes = piece_bounds(formula_, half) ? 1 : 0;
    half[axis] = {middle, piece[axis].high};
    return nodes + (piece_bounds(formula_, half) ? 1 : 0);
  }

  const Expression& formula_;
  const NamedBox& box_;
  std::size_t max_pieces_;
  std::vector<std::size_t> columns_;
  Json entries_ = Json::array();
};

}  // namespace

std::optional<std::string> write_certificate(const Expression& original, const NamedBox& named,
                                             std::size_t max_pieces) {
  check_box(original, named.ranges);
  // As the checker will read them: signs that the formula does not use are gone.
  NamedBox box = parse_box(print_box(named));
  const Expression formula = parse_over(print(original, named.names), box);
  Writer writer(formula, box, max_pieces);
  for (const Piece& cell : certificate_cells(formula, box.ranges)) {
    if (!writer.cover(cell)) return std::nullopt;
  }
  Json json = {{"format", "tribench certificate 1"},
               {"formula", print(formula, box.names)},
               {"box", print_box(box)},
               {"entries", writer.take_entries()}};
  json["digest"] = certificate_digest(json.dump());
  return json.dump(1);
}

}  // namespace tribench
