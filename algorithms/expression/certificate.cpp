// SPDX-License-Identifier: MIT
//
// Writing certificates: cutting the box until the checker's own bounds suffice.
#include "algorithms/expression/certificate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "algorithms/expression/text.hpp"
#include "foundation/json_text.hpp"

namespace tribench {
namespace {

using Json = nlohmann::ordered_json;

class Writer {
 public:
  Writer(const ClaimedFormula& formula, const ClaimedBox& box, const CertificateClaim& claim,
         std::size_t max_pieces)
      : formula_(formula),
        box_(box),
        claim_(claim),
        velocity_(claim_velocity(claim, box)),
        max_pieces_(max_pieces) {
    // A claim about the velocity is cut at its sign even where the formula has no such input.
    if (claim.kind == CertificateClaim::Kind::dissipative) columns_.push_back(velocity_);
    for (const ClaimedNode& node : formula) {
      if (node.op == Op::variable) columns_.push_back(node.input);
    }
    std::sort(columns_.begin(), columns_.end());
    columns_.erase(std::unique(columns_.begin(), columns_.end()), columns_.end());
  }

  // False where the pieces do not suffice.
  bool cover(const Piece& piece) {
    if (entries_.size() >= max_pieces_) return false;
    if (const auto bounds = proving_bounds(piece)) {
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
  std::optional<PieceRange> proving_bounds(const Piece& piece) const {
    const auto bounds = piece_bounds(formula_, piece);
    if (!bounds || !claim_holds(claim_, velocity_, piece, *bounds)) return std::nullopt;
    return bounds;
  }

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

  // Tries a cut along each input and takes the one that proves more halves, else the widest.
  std::optional<std::pair<std::size_t, double>> choose_cut(const Piece& piece) const {
    std::optional<std::pair<std::size_t, double>> best;
    std::size_t most = 0;
    double widest = -1;
    for (const std::size_t j : columns_) {
      const double middle = middle_of(piece[j]);
      if (!(piece[j].low < middle && middle < piece[j].high)) continue;
      const std::size_t halves = proved_halves(piece, j, middle);
      const double width =
          (piece[j].high - piece[j].low) / (box_.ranges[j].high - box_.ranges[j].low);
      if (best && (halves < most || (halves == most && width <= widest))) continue;
      best = {j, middle};
      most = halves;
      widest = width;
    }
    return best;
  }

  std::size_t proved_halves(const Piece& piece, std::size_t axis, double middle) const {
    Piece half = piece;
    half[axis].high = middle;
    const std::size_t lower = proving_bounds(half) ? 1 : 0;
    half[axis] = {middle, piece[axis].high};
    return lower + (proving_bounds(half) ? 1 : 0);
  }

  const ClaimedFormula& formula_;
  const ClaimedBox& box_;
  const CertificateClaim& claim_;
  std::size_t velocity_;
  std::size_t max_pieces_;
  std::vector<std::size_t> columns_;
  Json entries_ = Json::array();
};

Json claim_json(const CertificateClaim& claim) {
  switch (claim.kind) {
    case CertificateClaim::Kind::bounded:
      return {{"bounded", claim.limit}};
    case CertificateClaim::Kind::dissipative:
      return {{"dissipative", claim.velocity}};
    default:
      return "finite";
  }
}

}  // namespace

std::optional<std::string> write_certificate(const Expression& original, const NamedBox& named,
                                             std::size_t max_pieces,
                                             const CertificateClaim& claim) {
  check_box(original, named.ranges);
  // As the checker will read them: signs that the formula does not use are gone.
  const std::string text = print(original, named.names);
  ClaimedBox box = read_claimed_box(print_box(named));
  const ClaimedFormula formula = read_claimed_formula(text, box);
  Writer writer(formula, box, claim, max_pieces);
  const std::optional<std::vector<Piece>> cells = certificate_cells(formula, box, max_pieces);
  if (!cells) return std::nullopt;
  for (const Piece& cell : *cells) {
    if (!writer.cover(cell)) return std::nullopt;
  }
  Json json = {{"format", "tribench certificate 2"},
               {"formula", text},
               {"box", print_box(named)},
               {"claim", claim_json(claim)},
               {"entries", writer.take_entries()}};
  json["digest"] = certificate_digest(write_json(json));
  return write_json(json, 1);
}

}  // namespace tribench
