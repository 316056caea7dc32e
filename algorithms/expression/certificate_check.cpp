// SPDX-License-Identifier: MIT
//
// The checker. Compiled with -frounding-math; everything between UpwardRounding's constructor and
// destructor rounds upward, and a lower bound is the negative of an upper one.
#include <algorithm>
#include <array>
#include <cfenv>
#include <cmath>
#include <limits>
#include <new>
#include <nlohmann/json.hpp>

#include "algorithms/expression/certificate.hpp"
#include "foundation/error.hpp"
#include "foundation/json_text.hpp"

namespace tribench {
namespace {

using Json = nlohmann::ordered_json;
using Range = PieceRange;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kKernelSlack = 8 * std::numeric_limits<double>::epsilon();
constexpr double kTiny = std::numeric_limits<double>::denorm_min();

class UpwardRounding {
 public:
  UpwardRounding() : before_(std::fegetround()) { std::fesetround(FE_UPWARD); }
  ~UpwardRounding() { std::fesetround(before_); }
  UpwardRounding(const UpwardRounding&) = delete;
  UpwardRounding& operator=(const UpwardRounding&) = delete;

 private:
  int before_;
};

bool is_finite(const Range& x) { return x.low > -kInf && x.high < kInf; }
constexpr Range kNowhere{-kInf, kInf};

Range add(const Range& a, const Range& b) { return {-(-a.low - b.low), a.high + b.high}; }
Range minus(const Range& a) { return {-a.high, -a.low}; }

Range multiply(const Range& a, const Range& b) {
  return {-std::max({-a.low * b.low, -a.low * b.high, -a.high * b.low, -a.high * b.high}),
          std::max({a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high})};
}

Range divide(const Range& a, const Range& b) {
  if (b.low <= 0 && b.high >= 0) return kNowhere;
  return {-std::max({-a.low / b.low, -a.low / b.high, -a.high / b.low, -a.high / b.high}),
          std::max({a.low / b.low, a.low / b.high, a.high / b.low, a.high / b.high})};
}

Range absolute(const Range& a) {
  if (a.low >= 0) return a;
  if (a.high <= 0) return minus(a);
  return {0, std::max(-a.low, a.high)};
}

Range square_root(const Range& a) {
  if (a.low < 0) return kNowhere;
  const double low = std::sqrt(a.low);
  const bool is_exact = std::fma(low, low, -a.low) == 0 && (a.low == 0 || a.low > 1e-290);
  return {is_exact ? low : std::max(std::nextafter(low, -kInf), 0.0), std::sqrt(a.high)};
}

// A library function at one point in round-to-nearest, moved outward by the kernels' slack.
template <typename F>
Range kernel(F f, double x) {
  std::fesetround(FE_TONEAREST);
  const volatile double nearest = f(x);  // volatile: what follows stays behind the change of mode
  std::fesetround(FE_UPWARD);
  const double y = nearest;
  const double reach = std::abs(y) * kKernelSlack + kTiny;
  return {-(reach - y), y + reach};
}

template <typename F>
Range increasing(F f, const Range& a) {
  return {kernel(f, a.low).low, kernel(f, a.high).high};
}

Range exponential(const Range& a) {
  Range y = increasing([](double x) { return std::exp(x); }, a);
  y.low = y.low < 1e-307 ? 0 : y.low;  // kernels may flush what is below the normal range
  if (a.low >= 0) y.low = std::max(y.low, 1.0);
  if (a.high <= 0) y.high = std::min(y.high, 1.0);
  return y;
}

Range logarithm(const Range& a) {
  if (!(a.low > 0)) return kNowhere;
  Range y = increasing([](double x) { return std::log(x); }, a);
  if (a.low >= 1) y.low = std::max(y.low, 0.0);
  if (a.high <= 1) y.high = std::min(y.high, 0.0);
  return y;
}

Range hyperbolic_tangent(const Range& a) {
  const Range y = increasing([](double x) { return std::tanh(x); }, a);
  return {std::max(y.low, a.low >= 0 ? 0.0 : -1.0), std::min(y.high, a.high <= 0 ? 0.0 : 1.0)};
}

Range arc_tangent(const Range& a) {
  const Range y = increasing([](double x) { return std::atan(x); }, a);
  return {a.low >= 0 ? std::max(y.low, 0.0) : y.low, a.high <= 0 ? std::min(y.high, 0.0) : y.high};
}

// Lipschitz around the middle: crude, but short; exact at the ends of [-1, 1].
template <typename F>
Range wave(F f, const Range& a) {
  const double middle = a.low / 2 + a.high / 2;
  const double reach = std::max(a.high - middle, middle - a.low) + 1e-15 * (1 + std::abs(middle));
  if (!(reach < 2)) return {-1, 1};
  const Range y = add(kernel(f, middle), {-reach, reach});
  return {std::max(y.low, -1.0), std::min(y.high, 1.0)};
}

Range sign(const Range& a) {
  const auto of = [](double x) { return x > 0 ? 1.0 : (x < 0 ? -1.0 : 0.0); };
  return {of(a.low), of(a.high)};
}

Range whole_power(const Range& a, int n) {
  if (n < 0) return divide({1, 1}, whole_power(a, -n));
  const bool is_even = n % 2 == 0;
  const Range base = is_even ? absolute(a) : a;
  const auto upper =
      [n](double x) {  // x^n rounded up for x >= 0, by squaring as the evaluator does
        double result = 1;
        double square = x;
        for (int rest = n; rest > 0; rest >>= 1) {
          if ((rest & 1) != 0) result *= square;
          square *= square;
        }
        return result;
      };
  const auto lower = [n](double x) {  // x^n rounded down: the negative squares, rounded up
    double result = 1;
    double square = x;
    for (int rest = n; rest > 0; rest >>= 1) {
      if ((rest & 1) != 0) result = -(-result * square);
      square = -(-square * square);
    }
    return result;
  };
  return {base.low >= 0 ? lower(base.low) : -upper(-base.low),
          base.high >= 0 ? upper(base.high) : -lower(-base.high)};
}

Range power(const Range& a, const Range& b) {
  if (b.low == b.high && b.low == std::floor(b.low) && std::abs(b.low) <= 64) {
    return whole_power(a, static_cast<int>(b.low));
  }
  if (a.low < 0 || (a.low == 0 && b.low <= 0)) return kNowhere;
  Range all{kInf, -kInf};
  for (const double x : {a.low, a.high}) {
    for (const double y : {b.low, b.high}) {
      const Range corner = kernel([y](double t) { return std::pow(t, y); }, x);
      all = {std::min(all.low, corner.low), std::max(all.high, corner.high)};
    }
  }
  return {std::max(all.low, 0.0), all.high};
}

Range apply(Op op, const Range& a) {
  switch (op) {
    case Op::neg:
      return minus(a);
    case Op::exp:
      return exponential(a);
    case Op::log:
      return logarithm(a);
    case Op::sqrt:
      return square_root(a);
    case Op::abs:
      return absolute(a);
    case Op::sgn:
      return sign(a);
    case Op::sin:
      return wave([](double x) { return std::sin(x); }, a);
    case Op::cos:
      return wave([](double x) { return std::cos(x); }, a);
    case Op::atan:
      return arc_tangent(a);
    default:
      return hyperbolic_tangent(a);
  }
}

Range apply(Op op, const Range& a, const Range& b) {
  switch (op) {
    case Op::add:
      return add(a, b);
    case Op::sub:
      return add(a, minus(b));
    case Op::mul:
      return multiply(a, b);
    case Op::div:
      return divide(a, b);
    default:
      return power(a, b);
  }
}

// Reads the entries of a certificate against the cells they must cover.
class Reader {
 public:
  Reader(const ClaimedFormula& formula, const ClaimedBox& box, const CertificateClaim& claim,
         const Json& entries, const CertificateProgress& progress)
      : formula_(formula),
        box_(box),
        claim_(claim),
        velocity_(claim_velocity(claim, box)),
        entries_(entries),
        progress_(progress) {}

  // Empty where the entries prove the claim.
  std::string run() {
    // Each takes an entry at least.
    auto cells = certificate_cells(formula_, box_, entries_.size());
    if (!cells) return "the entries are fewer than the cells of the box";
    for (Piece& cell : *cells) {
      if (std::string reason = cover(cell, 0); !reason.empty()) return reason;
    }
    return next_ == entries_.size() ? "" : "entries are left over";
  }
  std::size_t pieces() const { return pieces_; }

 private:
  // piece: cut in place, so that thousands of cuts within one another take no memory; afterwards it
  // is as it was where nothing is said against it.
  std::string cover(Piece& piece, int depth) {
    if (next_ >= entries_.size()) return "the entries end before the box is covered";
    if (progress_) progress_(entries_.size());
    const Json& entry = entries_[next_++];
    const std::string place = " (entry " + std::to_string(next_) + ")";
    if (!entry.contains("cut")) return close(piece, entry, place);
    const auto axis = box_.place_of(entry["cut"].at(0).get<std::string>());
    const double at = entry["cut"].at(1);
    if (!axis || depth > 5000 || !(piece[*axis].low < at) || !(at < piece[*axis].high)) {
      return "a cut does not lie inside its piece" + place;
    }
    const Range side = piece[*axis];
    piece[*axis].high = at;
    if (std::string reason = cover(piece, depth + 1); !reason.empty()) return reason;
    piece[*axis] = {at, side.high};
    if (std::string reason = cover(piece, depth + 1); !reason.empty()) return reason;
    piece[*axis] = side;
    return "";
  }

  std::string close(const Piece& piece, const Json& entry, const std::string& place) {
    ++pieces_;
    const Json& sides = entry.at("piece");
    if (sides.size() != piece.size()) return "a piece lacks an input" + place;
    auto next = sides.begin();  // they stand in the box's order, as a rule
    for (std::size_t j = 0; j < piece.size(); ++j, ++next) {
      const bool is_here = sides.is_object() && next.key() == box_.names[j];
      const Json& side = is_here ? next.value() : sides.at(box_.names[j]);
      if (!(Range{side.at(0), side.at(1)} == piece[j])) {
        return "a piece is not the one that its cuts lead to" + place;
      }
    }
    const auto bounds = piece_bounds(formula_, piece);
    if (!bounds) return "the formula may not be finite on a piece" + place;
    const Range claimed{entry.at("bounds").at(0), entry.at("bounds").at(1)};
    if (!(claimed.low <= bounds->low && bounds->high <= claimed.high && is_finite(claimed))) {
      return "the formula may leave the bounds claimed on a piece" + place;
    }
    if (!claim_holds(claim_, velocity_, piece, *bounds)) {
      return "the property claimed may not hold on a piece" + place;
    }
    return "";
  }

  const ClaimedFormula& formula_;
  const ClaimedBox& box_;
  const CertificateClaim& claim_;
  std::size_t velocity_;
  const Json& entries_;
  const CertificateProgress& progress_;
  std::size_t next_ = 0;
  std::size_t pieces_ = 0;
};

CertificateClaim read_claim(const Json& json) {
  if (json == "finite") return {};
  if (json.size() != 1) throw_bad_input("a claim is one property", "claim");
  if (json.contains("bounded")) return {CertificateClaim::Kind::bounded, json["bounded"], ""};
  return {CertificateClaim::Kind::dissipative, 0, json.at("dissipative")};
}

std::string claim_text(const CertificateClaim& claim) {
  switch (claim.kind) {
    case CertificateClaim::Kind::bounded:
      return "finite and within +-" + write_json(Json(claim.limit));
    case CertificateClaim::Kind::dissipative:
      return "finite and of no other sign than " + claim.velocity;
    default:
      return "finite";
  }
}

void check_content(Json json, const CertificateProgress& progress, CertificateCheck& check) {
  const std::string digest = json.at("digest");
  json.erase("digest");
  if (json.at("format") != "tribench certificate 2") {
    check.reason = "the format is not known";
    return;
  }
  check.formula = json.at("formula");
  check.box = json.at("box");
  if (json.size() != 5 || certificate_digest(write_json(json)) != digest) {
    check.reason = "the digest does not fit the content";
    return;
  }
  ClaimedBox box = read_claimed_box(check.box);
  const ClaimedFormula formula = read_claimed_formula(check.formula, box);
  const CertificateClaim claim = read_claim(json.at("claim"));
  check.claim = claim_text(claim);
  Reader reader(formula, box, claim, json.at("entries"), progress);
  check.reason = reader.run();
  check.pieces = reader.pieces();
  check.accepted = check.reason.empty();
}

}  // namespace

namespace {
constexpr std::size_t kMostSidesOfCells = std::size_t{1} << 22;  // ranges in memory
}

std::optional<std::vector<Piece>> certificate_cells(const ClaimedFormula& formula,
                                                    const ClaimedBox& box, std::size_t most) {
  const std::size_t inputs = box.names.size();
  std::vector<bool> looks_at_sign(inputs, false);
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (formula[i].op != Op::variable) continue;
    const std::size_t input = formula[i].input;
    if (box.sign_of[input]) looks_at_sign[*box.sign_of[input]] = true;
    const Op above = i + 1 < formula.size() ? formula[i + 1].op : Op::constant;
    if (above == Op::abs || above == Op::sgn) looks_at_sign[input] = true;
  }
  std::vector<std::vector<std::size_t>> signs_of(inputs);
  for (std::size_t s = 0; s < inputs; ++s) {
    if (box.sign_of[s]) signs_of[*box.sign_of[s]].push_back(s);
  }
  std::vector<Piece> cells = {box.ranges};
  if (cells.size() > most) return std::nullopt;
  const std::size_t most_cells =
      std::min(most, kMostSidesOfCells / std::max<std::size_t>(inputs, 1));
  for (std::size_t j = 0; j < inputs; ++j) {
    if (!looks_at_sign[j]) continue;
    const Range& side = box.ranges[j];
    std::vector<Range> parts = {{side.low, std::min(side.high, -kTiny)},
                                {std::max(side.low, 0.0), std::min(side.high, 0.0)},
                                {std::max(side.low, kTiny), side.high}};
    std::erase_if(parts, [](const Range& part) { return part.low > part.high; });
    if (cells.size() * parts.size() > most_cells) return std::nullopt;
    std::vector<Piece> finer;
    for (const Piece& cell : cells) {
      for (const Range& part : parts) {
        finer.push_back(cell);
        finer.back()[j] = part;
        for (const std::size_t s : signs_of[j]) finer.back()[s] = sign(part);
      }
    }
    cells = std::move(finer);
  }
  return cells;
}

std::optional<PieceRange> piece_bounds(const ClaimedFormula& formula, const Piece& piece) {
  const UpwardRounding upward;
  std::vector<Range> stack;
  for (const ClaimedNode& node : formula) {
    if (node.op == Op::variable) {
      stack.push_back(piece[node.input]);
    } else if (node.op == Op::constant) {
      stack.push_back({node.value, node.value});
    } else if (arity(node.op) == 1) {
      stack.back() = apply(node.op, stack.back());
    } else {
      const Range right = stack.back();
      stack.pop_back();
      stack.back() = apply(node.op, stack.back(), right);
    }
    if (!is_finite(stack.back())) return std::nullopt;
  }
  return stack.back();
}

bool claim_holds(const CertificateClaim& claim, std::size_t velocity, const Piece& piece,
                 const PieceRange& bounds) {
  if (claim.kind == CertificateClaim::Kind::finite) return true;
  if (claim.kind == CertificateClaim::Kind::bounded) {
    return -claim.limit <= bounds.low && bounds.high <= claim.limit;
  }
  const PieceRange& v = piece[velocity];
  if (v.low == 0 && v.high == 0) return true;
  return (v.low >= 0 && bounds.low >= 0) || (v.high <= 0 && bounds.high <= 0);
}

std::size_t claim_velocity(const CertificateClaim& claim, const ClaimedBox& box) {
  if (claim.kind != CertificateClaim::Kind::dissipative) return 0;
  const auto place = box.place_of(claim.velocity);
  if (!place || box.sign_of[*place]) {
    throw_bad_input("'" + claim.velocity + "' is not an input of the box", "claim",
                    "name the velocity");
  }
  return *place;
}

std::string certificate_digest(std::string_view content) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;  // FNV-1a: against accidents, not against forgers
  for (const char c : content) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  std::string text(16, '0');
  for (std::size_t i = 16; i-- > 0; hash >>= 4) text[i] = "0123456789abcdef"[hash & 15];
  return text;
}

CertificateCheck check_certificate(std::string_view text, const CertificateProgress& progress) {
  CertificateCheck check;
  try {
    check_content(read_json_or_throw<Json>(text, "certificate"), progress, check);
  } catch (const nlohmann::detail::exception&) {
    check.reason = "the certificate cannot be read: a field is missing or of another kind";
  } catch (const std::bad_alloc&) {
    throw;  // that there is not enough memory says nothing of it
  } catch (const std::exception& error) {
    check.reason = std::string("the certificate cannot be read: ") + error.what();
  }
  return check;
}

}  // namespace tribench
