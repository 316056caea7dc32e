// SPDX-License-Identifier: MIT
//
// A proof that can be checked by someone who does not trust the prover: the box cut into pieces, on
// each of which plain interval arithmetic shows that every node of the formula is finite and, where
// that is claimed, that the value keeps to a limit or does not drive the joint (f v >= 0). The
// checker (certificate_check.cpp) shares no code with the prover: it reads formula and box by
// itself (certificate_formula.hpp), rounds by the processor's rounding modes, knows no derivative
// and no mean-value form, and covers the box by construction. What it trusts: the processor's
// rounding of
// + - * / sqrt, the C library's exp log sin cos tanh atan pow to 8 ulp, and the evaluator's kernels
// likewise.
//
// Not for monotony and oddness: the first needs derivatives, the second algebra, and the checker is
// kept to a size that can be read in one go.
//
// JSON: {"format", "formula", "box", "claim", "entries": [...], "digest"}, the claim being
// "finite", {"bounded": limit} or {"dissipative": "v"}. The entries walk the cells of the
// sign cases (an input whose sign matters: < 0, 0, > 0; the first input outermost) in order; in a
// cell, depth first, {"cut": ["v", 0.5]} halves the current piece at v = 0.5, lower half first, and
// {"piece": {"v": [low, high], ...}, "bounds": [low, high]} closes one.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/expression/certificate_formula.hpp"
#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/input_box.hpp"

namespace tribench {

// What is certified beyond finiteness, which every certificate claims.
struct CertificateClaim {
  enum class Kind { finite, bounded, dissipative };
  Kind kind = Kind::finite;
  double limit = 0;      // bounded: |f| <= limit
  std::string velocity;  // dissipative: the input whose sign f has, or is 0
};

// The certificate's text, or nothing where max_pieces do not suffice: a proof by sharper bounds
// than the checker's may need more. Write one only for a claim that is proved. Throws Error
// (bad_input) on a box that is none or a velocity that is not in it.
inline constexpr std::size_t kMaxPieces = 100'000;
std::optional<std::string> write_certificate(const Expression& formula, const NamedBox& box,
                                             std::size_t max_pieces = kMaxPieces,
                                             const CertificateClaim& claim = {});

struct CertificateCheck {
  bool accepted = false;
  std::string reason;  // why not
  std::string formula;
  std::string box;
  std::string claim;  // in words
  std::size_t pieces = 0;
};
// Told before each entry is checked; `entries` are all there are.
using CertificateProgress = std::function<void(std::size_t entries)>;
// Never throws on a bad certificate: what cannot be read is rejected, with the reason. Throws
// std::bad_alloc where there is not enough memory. Cost: nodes times pieces.
CertificateCheck check_certificate(std::string_view text, const CertificateProgress& progress = {});

// What the two sides share: how the box falls into cells, and the bounds on one piece. Each input
// whose sign the formula looks at makes three of one; nothing where there would be more than
// `most`.
std::optional<std::vector<Piece>> certificate_cells(const ClaimedFormula& formula,
                                                    const ClaimedBox& box, std::size_t most);
// The formula's range on the piece by natural interval extension; nothing where a node may not be
// finite.
std::optional<PieceRange> piece_bounds(const ClaimedFormula& formula, const Piece& piece);
// Whether a value within `bounds` on the piece keeps the claim; `velocity` is its input.
bool claim_holds(const CertificateClaim& claim, std::size_t velocity, const Piece& piece,
                 const PieceRange& bounds);
// The place of the claim's velocity; 0 where it has none. Throws Error (bad_input) on a name that
// is not in the box.
std::size_t claim_velocity(const CertificateClaim& claim, const ClaimedBox& box);
// Over the certificate's content without its digest.
std::string certificate_digest(std::string_view content);

}  // namespace tribench
