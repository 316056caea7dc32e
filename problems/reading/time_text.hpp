// SPDX-License-Identifier: MIT
//
// A time that is written as text: a date with a clock ("2024-05-14T09:12:33.5Z",
// "14.05.2024 09:12:33,500", "14-May-2024 09:12:33.5"), a clock alone ("09:12:33.500", "12:33.5" of
// minutes and seconds), a duration with its unit ("0.002 sec", "0 days 00:00:01.5").
//
// A date with slashes and the year last is not read: day and month cannot be told apart. What is
// left where it is passed over is the clock.
#pragma once

#include <optional>
#include <string_view>

namespace tribench {

// In seconds: of a date since 1970 (UTC where it names no zone), of a clock since midnight. None
// where the text is no such time; a bare number is none either, since its unit stands elsewhere.
std::optional<double> read_time_text(std::string_view text);

// What is understood, for messages.
std::string_view forms_of_time();

// The clock behind a date with slashes and the year last ("05/06/2024 1:02:03.5 PM"), in seconds
// since midnight. None where the text is no such time.
std::optional<double> read_clock_behind_date(std::string_view text);

}  // namespace tribench
