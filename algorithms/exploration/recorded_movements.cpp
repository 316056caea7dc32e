// SPDX-License-Identifier: MIT
#include "algorithms/exploration/recorded_movements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "algorithms/exploration/assessment.hpp"
#include "algorithms/exploration/foresight.hpp"
#include "algorithms/exploration/log_determinant.hpp"
#include "algorithms/exploration/movement_choice.hpp"
#include "foundation/error.hpp"
#include "foundation/random.hpp"

namespace tribench::loop {
namespace {

constexpr std::size_t kOpening = 2;      // movements before the first look
constexpr std::size_t kFewestRows = 30;  // of a part

struct Offered {
  std::vector<RowRange> rows;
  std::vector<double> seconds;
};

Offered offered_of(const Observations& data) {
  Offered out;
  out.rows = make_clusters(data.movement, 1).movements;
  for (const RowRange& range : out.rows) {
    const double first = data.time[range.begin];
    const double last = data.time[range.end - 1];
    const auto count = static_cast<double>(range.size());
    // The last row lasts as long as the others do.
    out.seconds.push_back(count > 1 ? (last - first) * count / (count - 1) : 1);
  }
  return out;
}

// The rows of the movements that are marked.
Observations rows_of(const Observations& data, const Offered& offered,
                     const std::vector<char>& marked) {
  std::vector<char> keep(data.rows(), 0);
  for (std::size_t m = 0; m < marked.size(); ++m) {
    const RowRange& range = offered.rows[m];
    std::fill(keep.begin() + static_cast<std::ptrdiff_t>(range.begin),
              keep.begin() + static_cast<std::ptrdiff_t>(range.end), marked[m]);
  }
  return data.select(keep);
}

struct Next {
  std::size_t movement = 0;
  std::string why;
};

// What is known when a movement is chosen.
struct Asking {
  const Offered& offered;
  const Foreseen& foreseen;
  const std::vector<char>& asked;
  const Assessment* last = nullptr;
};

// What tells most of the base, a second.
Next most_of_the_base(const Asking& now) {
  const Eigen::MatrixXd& base = now.foreseen.base;
  Eigen::MatrixXd known = Eigen::MatrixXd::Identity(base.cols(), base.cols());
  known *= 1e-6 * base.squaredNorm() / static_cast<double>(base.cols());
  const auto gram = [&](std::size_t m) -> Eigen::MatrixXd {
    const RowRange& range = now.offered.rows[m];
    const auto rows = base.middleRows(static_cast<Eigen::Index>(range.begin),
                                      static_cast<Eigen::Index>(range.size()));
    return rows.transpose() * rows;
  };
  for (std::size_t m = 0; m < now.asked.size(); ++m) {
    if (now.asked[m] != 0) known += gram(m);
  }
  const double before = log_determinant(known);
  std::optional<Next> best;
  double most = 0;
  for (std::size_t m = 0; m < now.asked.size(); ++m) {
    if (now.asked[m] != 0) continue;
    const double rate = (log_determinant(known + gram(m)) - before) / now.offered.seconds[m];
    if (best && !(rate > most)) continue;
    best = Next{m, "opening"};
    most = rate;
  }
  return best.value();
}

Next most_evidence(const Asking& now) {
  if (now.last == nullptr) return most_of_the_base(now);
  std::optional<Next> best;
  double most = 0;
  for (const MovementChoice& choice : movement_gains(*now.last, now.foreseen)) {
    if (now.asked[choice.movement] != 0) continue;
    const double rate = choice.gain / now.offered.seconds[choice.movement];
    if (best && !(rate > most)) continue;
    best = Next{choice.movement, choice.between};
    most = rate;
  }
  return best ? *best : most_of_the_base(now);
}

// `choose` names the next one that was not asked for; `told` is handed its number.
template <typename Choose, typename Told>
AskedRecordings ask(const Observations& data, const Offered& offered, const VerdictOf& verdict,
                    const std::string& whole, Choose choose, Told told) {
  if (offered.rows.size() <= kOpening) {
    throw_bad_input(fmt::format("there are {} movements", offered.rows.size()), "recordings",
                    "give recordings of three movements or more, or a shorter --longest");
  }
  std::vector<char> asked(offered.rows.size(), 0);
  AskedRecordings out;
  while (out.path.size() < asked.size()) {
    const Next next = choose(asked);
    asked[next.movement] = 1;
    out.path.push_back({next.movement, offered.seconds[next.movement], next.why});
    told(next.movement);
    if (out.path.size() >= kOpening && verdict(rows_of(data, offered, asked)) == whole) break;
  }
  return out;
}

// In place.
void cut(const std::vector<double>& time, double longest_s, std::vector<int>& movement,
         std::vector<std::string>& names) {
  std::vector<std::string> parted;
  for (const RowRange& range : make_clusters(movement, 1).movements) {
    const double begin = time[range.begin];
    const double whole = time[range.end - 1] - begin;
    const int wanted = static_cast<int>(std::ceil(whole / longest_s));
    const int parts =
        std::clamp(wanted, 1, std::max(1, static_cast<int>(range.size() / kFewestRows)));
    const int first = static_cast<int>(parted.size());
    const std::string& name = names[static_cast<std::size_t>(movement[range.begin])];
    for (int k = 0; k < parts; ++k) {
      parted.push_back(parts > 1 ? fmt::format("{} part {}", name, k + 1) : name);
    }
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const double place = whole > 0 ? (time[i] - begin) / whole * parts : 0;
      movement[i] = first + std::min(parts - 1, static_cast<int>(place));
    }
  }
  names = std::move(parted);
}

}  // namespace

Observations cut_movements(const Observations& data, double longest_s) {
  Observations out = data;
  out.group.clear();
  cut(data.time, longest_s, out.movement, out.movement_names);
  return out;
}

Dataset cut_movements(const Dataset& data, double longest_s) {
  Dataset out = data;
  std::vector<double> time(data.rows());
  std::iota(time.begin(), time.end(), 0.0);
  const Channel* clock = data.find(Role::time);
  cut(clock != nullptr ? clock->values : time, longest_s, out.movement, out.movement_names);
  return out;
}

double AskedRecordings::seconds() const {
  double sum = 0;
  for (const AskedMovement& one : path) sum += one.seconds;
  return sum;
}

AskedRecordings ask_for_recordings(const Observations& data, const std::vector<double>& gear_ratios,
                                   double alpha, const VerdictOf& verdict,
                                   const std::string& whole) {
  const Offered offered = offered_of(data);
  Observations known = data;
  add_warming(known, EarlierMovements::remembered);
  const ExplanationSpace space(known, gear_ratios);
  Foreseen foreseen{space.base_columns(known), space.columns(known), {}};
  for (const RowRange& range : offered.rows) foreseen.movements.push_back({range, 1});
  Assessor assessor(space, alpha);
  const auto choose = [&](const std::vector<char>& asked) {
    const bool known = assessor.movements() >= kOpening;
    return most_evidence({offered, foreseen, asked, known ? &assessor.last() : nullptr});
  };
  const auto told = [&](std::size_t movement) {
    std::vector<char> one(offered.rows.size(), 0);
    one[movement] = 1;
    assessor.add(rows_of(known, offered, one));
    if (assessor.movements() >= kOpening) assessor.look();
  };
  return ask(data, offered, verdict, whole, choose, told);
}

AskedRecordings draw_recordings(const Observations& data, const VerdictOf& verdict,
                                const std::string& whole, std::uint64_t seed) {
  RandomStream random = RandomStream(key_of("exploration/recordings")).split(seed);
  const auto choose = [&](const std::vector<char>& asked) {
    std::vector<std::size_t> left;
    for (std::size_t m = 0; m < asked.size(); ++m) {
      if (asked[m] == 0) left.push_back(m);
    }
    return Next{left[random.below(left.size())], "drawn"};
  };
  return ask(data, offered_of(data), verdict, whole, choose, [](std::size_t) {});
}

}  // namespace tribench::loop
