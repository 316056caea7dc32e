// SPDX-License-Identifier: MIT
#include "problems/reading/time_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <chrono>
#include <cmath>
#include <utility>

#include "foundation/text.hpp"
#include "problems/reading/units.hpp"

namespace tribench {
namespace {

bool begins_with_word(std::string_view text, std::string_view word) {
  return text.size() >= word.size() &&
         std::equal(word.begin(), word.end(), text.begin(), [](char a, char b) {
           return a == static_cast<char>(std::tolower(static_cast<unsigned char>(b)));
         });
}

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
  // Leaves the text as it is where it does not begin so; case does not matter.
  bool take_word(std::string_view word) {
    if (!begins_with_word(text_, word)) return false;
    text_.remove_prefix(word.size());
    return true;
  }
  void skip_blanks() {
    while (take(" ")) continue;
  }
  // Just so many digits, whatever follows.
  std::optional<int> digits(std::size_t count) {
    if (text_.size() < count ||
        text_.substr(0, count).find_first_not_of("0123456789") != std::string_view::npos) {
      return {};
    }
    int value = 0;
    std::from_chars(text_.data(), text_.data() + count, value);
    text_.remove_prefix(count);
    return value;
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
  if (!begins_with_word(rest, "am") && !begins_with_word(rest, "pm")) return 0;
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
  // "09:12:33:250" has thousandths behind its last colon.
  std::optional<double> fraction = front.fraction();
  if (front.take(":")) {
    const std::optional<int> thousandths = front.whole(3, 3);
    if (!thousandths || *fraction != 0) return {};
    fraction = *thousandths / 1000.0;
  }
  if (!fraction) return {};
  const std::optional<int> past_noon = take_half_of_day(front, *hours);
  if (!past_noon) return {};
  return 3600.0 * (*hours + *past_noon) + 60.0 * *minutes + *seconds + *fraction;
}

// "091233.25", as it stands behind a date without strokes.
std::optional<double> take_plain_clock(Front& front) {
  const std::optional<int> hours = front.digits(2);
  const std::optional<int> minutes = front.digits(2);
  const std::optional<int> seconds = front.digits(2);
  if (!hours || !minutes || !seconds || *hours > 23 || *minutes > 59 || *seconds > 60) return {};
  const std::optional<double> fraction = front.fraction();
  if (!fraction) return {};
  return 3600.0 * *hours + 60.0 * *minutes + *seconds + *fraction;
}

// "12:33.250", minutes and seconds. Without a fraction it may as well be hours and minutes.
std::optional<double> read_minutes(std::string_view text) {
  Front front(text);
  const std::optional<int> minutes = front.whole(1, 3);
  if (!minutes || !front.take(":")) return {};
  const std::optional<int> seconds = front.whole(2, 2);
  if (!seconds || *seconds > 59 || front.at_end()) return {};
  const std::optional<double> fraction = front.fraction();
  if (!fraction || !front.at_end()) return {};
  return 60.0 * *minutes + *seconds + *fraction;
}

// "0 days 00:00:00.25", as pandas writes a duration.
std::optional<double> read_days(std::string_view text) {
  Front front(text);
  const std::optional<int> days = front.whole(1, 6);
  front.skip_blanks();
  if (!days || (!front.take_word("days") && !front.take_word("day"))) return {};
  front.skip_blanks();
  const std::optional<double> clock = front.at_end() ? 0.0 : take_clock(front);
  if (!clock || !front.at_end()) return {};
  return 86400.0 * *days + *clock;
}

// Seconds to be taken off; 0 where no zone is named.
std::optional<double> take_zone(Front& front) {
  front.take(" ");
  if (front.at_end() || front.take_word("z") || front.take_word("utc") || front.take_word("gmt")) {
    return 0.0;
  }
  const double sign = front.rest().front() == '-' ? -1 : 1;
  if (!front.take("+-")) return {};
  const std::optional<int> hours = front.digits(2);
  front.take(":");
  const std::optional<int> minutes = front.at_end() ? 0 : front.digits(2);
  if (!hours || !minutes) return {};
  return sign * (3600.0 * *hours + 60.0 * *minutes);
}

// From 1 to 12, of an English or a German name or its first three letters.
std::optional<int> take_month(Front& front) {
  constexpr std::array<std::pair<std::string_view, int>, 32> kMonths = {{
      {"january", 1},    {"february", 2},  {"march", 3},    {"april", 4},     {"may", 5},
      {"june", 6},       {"july", 7},      {"august", 8},   {"september", 9}, {"october", 10},
      {"november", 11},  {"december", 12}, {"oktober", 10}, {"dezember", 12}, {"jan", 1},
      {"feb", 2},        {"mar", 3},       {"apr", 4},      {"jun", 6},       {"jul", 7},
      {"aug", 8},        {"sept", 9},      {"sep", 9},      {"oct", 10},      {"nov", 11},
      {"dec", 12},       {"mai", 5},       {"okt", 10},     {"dez", 12},      {"m\xC3\xA4rz", 3},
      {"m\xC3\xA4r", 3}, {"mrz", 3},
  }};
  for (const auto& [name, month] : kMonths) {
    if (front.take_word(name)) return month;
  }
  return {};
}

std::optional<double> date_of(int year, int month, int day) {
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (!date.ok()) return {};
  return 86400.0 * static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
}

// "14-May-2024", "14. May 2024", "May 14, 2024".
std::optional<double> take_date_with_month(Front& front) {
  std::optional<int> day = front.whole(1, 2);
  const bool day_first = day.has_value();
  if (day_first) {
    front.take(".");
    front.take("- ");
  }
  const std::optional<int> month = take_month(front);
  if (!month) return {};
  front.take(".,");
  front.take("- ");
  if (!day_first) {
    day = front.whole(1, 2);
    front.take(",");
    front.take("- ");
  }
  const std::optional<int> year = front.whole(4, 4);
  if (!day || !year) return {};
  return date_of(*year, *month, *day);
}

std::optional<double> take_date(Front& front) {
  const std::optional<int> first = front.whole(1, 4);
  if (!first) return {};
  const bool year_first = *first > 31;
  const bool parted = year_first ? front.take("-/.") : front.take(".");
  const std::optional<int> month = parted ? front.whole(1, 2) : std::nullopt;
  if (!month || !front.take(year_first ? "-/." : ".")) return {};
  const std::optional<int> last = year_first ? front.whole(1, 2) : front.whole(4, 4);
  if (!last) return {};
  return date_of(year_first ? *first : *last, *month, year_first ? *last : *first);
}

// "20240514T091233.25Z"
std::optional<double> read_plain_date(std::string_view text) {
  Front front(text);
  const std::optional<int> year = front.digits(4);
  const std::optional<int> month = front.digits(2);
  const std::optional<int> day = front.digits(2);
  if (!year || !month || !day || !front.take("Tt_ -")) return {};
  const std::optional<double> days = date_of(*year, *month, *day);
  const std::optional<double> clock = take_plain_clock(front);
  if (!days || !clock) return {};
  const std::optional<double> zone = take_zone(front);
  if (!zone || !front.at_end()) return {};
  return *days + *clock - *zone;
}

std::optional<double> read_date(std::string_view text) {
  Front front(text);
  std::optional<double> days = take_date(front);
  if (!days) {
    front = Front(text);
    days = take_date_with_month(front);
  }
  front.take(",");
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
  for (const auto read : {read_date, read_plain_date, read_minutes, read_days}) {
    if (const std::optional<double> time = read(text)) return time;
  }
  Front front(text);
  if (const std::optional<double> clock = take_clock(front); clock && front.at_end()) return clock;
  return read_duration(text);
}

std::string_view forms_of_time() {
  return "2024-05-14T09:12:33.5Z, 14.05.2024 09:12:33.5, 14-May-2024 09:12:33.5, 09:12:33.5, "
         "12:33.5 (minutes and seconds), 0 days 00:00:01.5";
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
