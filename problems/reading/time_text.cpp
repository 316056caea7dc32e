// SPDX-License-Identifier: MIT
#include "problems/reading/time_text.hpp"

#include <charconv>
#include <chrono>
#include <cmath>

#include "foundation/text.hpp"
#include "problems/reading/units.hpp"

namespace tribench {
namespace {

// Takes what a text is made of off its front.
class Front {
 public:
  explicit Front(std::string_view text) : text_(text) {}

  bool at_end() const { return text_.empty(); }
  std::string_view rest() const { return text_; }
  bool take(std::string_view any_of) {
    if (text_.empty() || any_of.find(text_.front()) == std::string_view::npos) return false;
    text_.remove_prefix(1);
    return true;
  }
  // A whole number of `fewest` to `most` digits.
  std::optional<int> whole(std::size_t fewest, std::size_t most) {
    const std::size_t digits = std::min(text_.find_first_not_of("0123456789"), text_.size());
    if (digits < fewest || digits > most) return {};
    int value = 0;
    std::from_chars(text_.data(), text_.data() + digits, value);
    text_.remove_prefix(digits);
    return value;
  }
  // What follows the point of a second; 0 without one.
  std::optional<double> fraction() {
    if (!take(".,")) return 0.0;
    const std::size_t digits = std::min(text_.find_first_not_of("0123456789"), text_.size());
    if (digits == 0 || digits > 18) return {};
    double value = 0;
    std::from_chars(text_.data(), text_.data() + digits, value);
    text_.remove_prefix(digits);
    for (std::size_t i = 0; i < digits; ++i) value /= 10;
    return value;
  }

 private:
  std::string_view text_;
};

// Hours that "AM" or "PM" add; 0 where neither follows.
std::optional<int> take_half_of_day(Front& front, int hours) {
  const std::string_view rest = trimmed(front.rest());
  if (rest.size() < 2 || (rest[1] != 'M' && rest[1] != 'm')) return 0;
  front.take(" ");
  const bool morning = front.take("Aa");
  if (!morning && !front.take("Pp")) return {};
  front.take("Mm");
  if (hours < 1 || hours > 12) return {};
  return (hours == 12 ? -12 : 0) + (morning ? 0 : 12);
}

std::optional<double> take_clock(Front& front) {
  const std::optional<int> hours = front.whole(1, 2);
  if (!hours || *hours > 23 || !front.take(":")) return {};
  const std::optional<int> minutes = front.whole(2, 2);
  if (!minutes || *minutes > 59 || !front.take(":")) return {};
  const std::optional<int> seconds = front.whole(2, 2);
  if (!seconds || *seconds > 60) return {};
  const std::optional<double> fraction = front.fraction();
  if (!fraction) return {};
  const std::optional<int> past_noon = take_half_of_day(front, *hours);
  if (!past_noon) return {};
  return 3600.0 * (*hours + *past_noon) + 60.0 * *minutes + *seconds + *fraction;
}

// Seconds to be taken off; 0 where no zone is named.
std::optional<double> take_zone(Front& front) {
  front.take(" ");
  if (front.at_end() || front.take("Zz")) return 0.0;
  const double sign = front.rest().front() == '-' ? -1 : 1;
  if (!front.take("+-")) return {};
  const std::optional<int> hours = front.whole(2, 2);
  front.take(":");
  const std::optional<int> minutes = front.at_end() ? 0 : front.whole(2, 2);
  if (!hours || !minutes) return {};
  return sign * (3600.0 * *hours + 60.0 * *minutes);
}

std::optional<double> take_date(Front& front) {
  std::optional<int> year;
  std::optional<int> day;
  const std::optional<int> first = front.whole(1, 4);
  if (!first) return {};
  const bool year_first = *first > 31;
  const bool parted = year_first ? front.take("-/.") : front.take(".");
  const std::optional<int> month = parted ? front.whole(1, 2) : std::nullopt;
  if (!month || !front.take(year_first ? "-/." : ".")) return {};
  const std::optional<int> last = year_first ? front.whole(1, 2) : front.whole(4, 4);
  if (!last) return {};
  year = year_first ? first : last;
  day = year_first ? last : first;
  const std::chrono::year_month_day date{std::chrono::year(*year),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day))};
  if (!date.ok()) return {};
  return 86400.0 * static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
}

std::optional<double> read_date(std::string_view text) {
  Front front(text);
  const std::optional<double> days = take_date(front);
  if (!days || !front.take("Tt _")) return {};
  const std::optional<double> clock = take_clock(front);
  if (!clock) return {};
  const std::optional<double> zone = take_zone(front);
  if (!zone || !front.at_end()) return {};
  return *days + *clock - *zone;
}

std::optional<double> read_duration(std::string_view text) {
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || !std::isfinite(value)) return {};
  const Unit* unit = find_unit(text.substr(static_cast<std::size_t>(end - text.data())));
  if (unit == nullptr || unit->dimension != Dimension::time) return {};
  return value * unit->factor;
}

}  // namespace

std::optional<double> read_time_text(std::string_view text) {
  text = trimmed(text);
  if (const std::optional<double> date = read_date(text)) return date;
  Front front(text);
  if (const std::optional<double> clock = take_clock(front); clock && front.at_end()) return clock;
  return read_duration(text);
}

std::optional<double> read_clock_behind_date(std::string_view text) {
  Front front(trimmed(text));
  for (const std::size_t digits : {2, 2}) {
    if (!front.whole(1, digits) || !front.take("/")) return {};
  }
  if (!front.whole(2, 4) || !front.take(" ,_T")) return {};
  front.take(" ");
  const std::optional<double> clock = take_clock(front);
  return clock && front.at_end() ? clock : std::nullopt;
}

}  // namespace tribench
