// SPDX-License-Identifier: MIT
#include "algorithms/external/answer_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <initializer_list>
#include <new>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "algorithms/admission.hpp"
#include "algorithms/expression/text.hpp"
#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "foundation/suggestion.hpp"
#include "foundation/text.hpp"

namespace tribench {
namespace {

using nlohmann::json;

constexpr std::size_t kQuotedCharacters = 200;
// Of a front, one a complexity: each is simplified, proved and judged, in about 0.2 ms at least.
constexpr std::size_t kMostFormulas = 10'000;

[[noreturn]] void throw_unusable(std::string_view what) { throw Error(ErrorKind::failed, what); }

std::string excerpt(std::string_view text) {
  std::string shown(text.substr(0, kQuotedCharacters));
  for (char& c : shown) {
    if (c < ' ' || c > '~') c = ' ';
  }
  return shown;
}

std::string last_line(std::string_view text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.remove_suffix(1);
  const std::size_t start = text.rfind('\n');
  return excerpt(start == std::string_view::npos ? text : text.substr(start + 1));
}

bool holds_any(std::string_view text, std::initializer_list<std::string_view> words) {
  return std::ranges::any_of(
      words, [&](std::string_view one) { return text.find(one) != std::string_view::npos; });
}

// What languages say that were refused memory; the program's exit status says no more than that it
// has failed.
bool tells_of_no_memory(std::string_view errors) {
  return holds_any(errors, {
                               "MemoryError",           // Python
                               "std::bad_alloc",        // C++
                               "OutOfMemoryError",      // Java, Julia
                               "cannot allocate",       // R, Go
                               "Cannot allocate",       // the C library: ENOMEM
                               "Unable to allocate",    // NumPy
                               "memory allocation of",  // Rust
                               "out of memory",         // Octave
                           });
}

// What the C library says of files that could not be written, and a shell of a program that was
// ended for it.
bool tells_of_full_disk(std::string_view errors) {
  return holds_any(errors, {"No space left on device", "Disk quota exceeded", "File too large",
                            "File size limit exceeded"});
}

// A count in the program's answer.
std::uint64_t count_in(const json& object, const char* key, std::uint64_t otherwise) {
  if (!object.contains(key)) return otherwise;
  const json& value = object.at(key);
  // A program may count in doubles; nothing that runs within a budget counts beyond them, and a
  // negative number that was taken for a large one does.
  constexpr std::uint64_t kExact = std::uint64_t{1} << 53;
  const auto count = json_whole_number<std::uint64_t>(value);
  if (count && *count <= kExact) return *count;
  const double number = value.is_number_float() ? value.get<double>() : -1;
  if (number >= 0 && number <= static_cast<double>(kExact) && number == std::floor(number)) {
    return static_cast<std::uint64_t>(number);
  }
  throw_unusable(fmt::format("'{}' is {}, not a whole number from 0 to {}", key,
                             excerpt(write_json(value)), kExact));
}

// One line, which a terminal shows as it is and does not obey.
std::string text_in(const json& value, const char* key) {
  if (value.is_string()) return without_control_characters(value.get<std::string>());
  throw_unusable(fmt::format("'{}' is {}, not text", key, excerpt(write_json(value))));
}

bool is_answer(const json& line) {
  return line.is_object() &&
         (line.contains("improved") || line.contains("unsupported") || line.contains("front"));
}

// A key that is only nearly right ("choosen") would be a choice that nobody hears of.
void require_known_keys(const json& answer) {
  static const std::vector<std::string> kKeys = {"improved", "unsupported", "front",
                                                 "chosen",   "evaluations", "note"};
  for (const auto& [key, value] : answer.items()) {
    if (std::ranges::count(kKeys, key) > 0) continue;
    throw_unusable(fmt::format("the program's answer has a key '{}' that is not known; {}",
                               excerpt(key), did_you_mean(key, kKeys)));
  }
  if (answer.contains("front") && answer.contains("unsupported")) {
    throw_unusable("the program's answer has a front and says that it is unsupported; print one");
  }
}

void take_improvement(FitContext& context, const json& improvement) {
  if (context.progress == nullptr) return;
  if (!improvement.is_object() || !improvement.contains("train_error") ||
      !improvement.at("train_error").is_number()) {
    throw_unusable(fmt::format("'improved' is {}, not {{\"train_error\": NUMBER}}",
                               excerpt(write_json(improvement))));
  }
  context.progress->improved(improvement.at("train_error").get<double>(),
                             count_in(improvement, "evaluations", 0));
}

// Formulas beyond a prior go, and those not proved free where the operator set admits no others.
// The next simpler one that is left stands in for a choice that goes, else the simplest.
void keep_admitted_formulas(const FitContext& context, std::span<const std::string> names,
                            FitResult& result) {
  const Admission admission(context);
  std::vector<Expression> kept;
  std::size_t chosen = 0;
  if (!admission.may_be_offered(result.front[result.chosen])) {
    result.note += fmt::format("{}its choice {} is not admitted, another formula stands in",
                               result.note.empty() ? "" : "; ",
                               excerpt(print(result.front[result.chosen], names)));
  }
  for (std::size_t k = 0; k < result.front.size(); ++k) {
    if (!admission.may_be_offered(result.front[k])) continue;
    if (k <= result.chosen) chosen = kept.size();
    kept.push_back(std::move(result.front[k]));
  }
  if (kept.empty())
    throw_unusable("no formula of the front keeps to the priors and, where asked, is proved free");
  result.front = std::move(kept);
  result.chosen = chosen;
}

}  // namespace

AnswerReader::AnswerReader(FitContext& context) : context_(context) {
  for (const Input& input : context.data.inputs) names_.push_back(input.name);
}

void AnswerReader::take(std::string_view text) {
  pending_ += text;
  std::size_t start = 0;
  for (std::size_t end = pending_.find('\n'); end != std::string::npos;
       end = pending_.find('\n', start)) {
    take_line(pending_.substr(start, end - start));
    start = end + 1;
  }
  pending_.erase(0, start);
}

FitResult AnswerReader::finish(const ChildExit& exit, std::string_view errors) {
  if (!pending_.empty()) take_line(std::exchange(pending_, {}));
  if (exit.signal == SIGXFSZ) {
    throw Error(ErrorKind::environment, "the program met a limit on the size of files", {},
                "raise it: ulimit -f unlimited");
  }
  const bool has_failed = exit.signal != 0 || exit.status != 0;
  if (has_failed && tells_of_no_memory(errors)) throw std::bad_alloc();
  // By the time it has ended its folder is gone and there is room again.
  if (has_failed && tells_of_full_disk(errors)) {
    throw Error(ErrorKind::environment,
                fmt::format("there was no room to write for the program: {}", last_line(errors)),
                {}, "make room in the folder of temporary files, or name another by TMPDIR");
  }
  if (exit.signal != 0) {
    throw_unusable(fmt::format("the program was ended by {}", signal_name(exit.signal)));
  }
  if (exit.status != 0) {
    throw_unusable(
        fmt::format("the program ended with status {}: {}", exit.status, last_line(errors)));
  }
  if (!unread_.empty()) throw_unusable(unread_);
  if (result_) return std::move(*result_);
  throw_unusable(other_output_.empty()
                     ? std::string("the program printed no front")
                     : fmt::format("the program printed no front but '{}'", other_output_));
}

// Lines that are no JSON object, or one of the program's own log, are its chatter; one that cannot
// be read is, too, unless it has a key of an answer.
void AnswerReader::take_line(const std::string& line) {
  const std::size_t start = std::min(line.find_first_not_of(" \t"), line.size());
  std::string reason;
  const json object = line.substr(start, 1) == "{" ? read_json<json>(line, &reason)
                                                   : json(json::value_t::discarded);
  if (!is_answer(object)) {
    if (other_output_.empty()) other_output_ = excerpt(line);
    const bool is_meant = holds_any(line, {"\"front\"", "\"unsupported\"", "\"improved\""});
    if (unread_.empty() && !reason.empty() && is_meant) {
      unread_ =
          fmt::format("the program's answer cannot be read: {} of '{}'", reason, excerpt(line));
    }
    return;
  }
  require_known_keys(object);
  if (object.contains("improved")) take_improvement(context_, object.at("improved"));
  if (object.contains("unsupported")) {
    result_ = FitResult::unsupported(text_in(object.at("unsupported"), "unsupported"));
  }
  if (object.contains("front")) take_front(object);
}

void AnswerReader::take_front(const nlohmann::json& object) {
  FitResult result;
  const json& front = object.at("front");
  if (!front.is_array()) {
    throw_unusable(
        fmt::format("'front' is {}, not a list of formulas", excerpt(write_json(front))));
  }
  if (front.empty()) throw_unusable("the program's front is empty");
  if (front.size() > kMostFormulas) {
    throw_unusable(fmt::format("the program's front has {} formulas, more than {}", front.size(),
                               kMostFormulas));
  }
  for (const json& formula : front) {
    result.front.push_back(parse_formula(text_in(formula, "front")));
  }
  result.chosen = count_in(object, "chosen", result.front.size() - 1);
  if (result.chosen >= result.front.size()) {
    throw_unusable(
        fmt::format("'chosen' is {} in a front of {}", result.chosen, result.front.size()));
  }
  if (object.contains("note")) result.note = text_in(object.at("note"), "note");
  result.keeps_choice = true;
  keep_admitted_formulas(context_, names_, result);
  context_.budget.book(count_in(object, "evaluations", 0));
  result_ = std::move(result);
}

Expression AnswerReader::parse_formula(const std::string& text) const {
  try {
    Expression formula = parse(text, names_);
    if (context_.operators.admits(formula)) return formula;
  } catch (const Error& error) {
    throw_unusable(fmt::format("the formula '{}' cannot be read: {}", excerpt(text), error.what()));
  }
  throw_unusable(fmt::format("the formula '{}' leaves the operator set {}", excerpt(text),
                             context_.operators.name()));
}

}  // namespace tribench
