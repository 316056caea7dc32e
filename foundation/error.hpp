// SPDX-License-Identifier: MIT
//
// The one kind of error that leaves a room: what happened, where, and what to do about it.
// For bad input and for failures of the outside world (a file, a process). Not for numerical
// trouble, which is a status in a result, and not for bugs, which are assertions.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace tribench {

// Decides the program's exit status.
enum class ErrorKind {
  bad_input,  // the user can mend it: exit status 2
  failed,     // the machine or a bug is at fault: exit status 3
  // The machine has no room now (a full disk, a limit on files or processes): says nothing about
  // what was tried, which can be repeated; exit status 3 too, and never a cell's result.
  environment,
};

class Error : public std::runtime_error {
 public:
  // what: one sentence with the values that are wrong. place: "file:line:column", a key or an
  // option, may be empty. mend: what to do, may be empty.
  Error(ErrorKind kind, std::string_view what, std::string_view place = {},
        std::string_view mend = {});

  ErrorKind kind() const { return kind_; }
  const std::string& text() const { return text_; }  // `what` alone
  const std::string& place() const { return place_; }
  const std::string& mend() const { return mend_; }

 private:
  ErrorKind kind_;
  std::string text_;
  std::string place_;
  std::string mend_;
};

// Throws an Error of kind bad_input.
[[noreturn]] void throw_bad_input(std::string_view what, std::string_view place = {},
                                  std::string_view mend = {});

// Runs `action`; an Error that leaves it gets the place of the text that `action` was made from,
// and its own place, if it has one, comes to stand behind that. One that has a place in the same
// file already keeps it: it is nearer.
template <typename Action>
decltype(auto) at_place(std::string_view place, Action action) {
  try {
    return action();
  } catch (const Error& error) {
    const std::string_view file = place.substr(0, place.find(':'));
    if (place.empty() || error.place().starts_with(std::string(file) + ":")) throw;
    const std::string inner = error.place().empty() ? std::string() : error.place() + ": ";
    throw Error(error.kind(), inner + error.text(), place, error.mend());
  }
}

}  // namespace tribench
