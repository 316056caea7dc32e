// SPDX-License-Identifier: MIT
//
// Text in pieces and whole files. Bytes throughout: nothing here depends on the locale.
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tribench {

// Without blanks, tabs and line ends on either side.
std::string_view trimmed(std::string_view text);

// As a sentence begins: the first letter large, where it is one of ASCII's.
std::string capitalised(std::string text);

// ASCII's letters made small.
std::string in_small_letters(std::string_view text);

// As RFC 3629 has it: no overlong forms, no halves of a pair.
bool is_utf8(std::string_view text);

// ASCII's and Unicode's control characters (as UTF-8): they show nothing, and a terminal obeys
// them.
bool holds_control_characters(std::string_view text);
// With a blank in place of tabs and line ends, and '?' in place of each other one.
std::string without_control_characters(std::string_view text);
// The same of several lines, whose ends stay.
std::string lines_without_control_characters(std::string_view text);

// What a message shows of a text that may have any length: its first `most` bytes in whole
// characters, and "..." where there is more.
std::string clipped(std::string_view text, std::size_t most = 60);

// The pieces between separators, trimmed: "a, b" at ',' gives "a" and "b"; "a,,b" has an empty
// piece; an empty or blank text has none.
std::vector<std::string> split(std::string_view text, char separator);

// The words of a command as a shell would part them; quotes hold words together. Throws Error
// (bad_input) at `place` where there is none, or a quote is left open.
std::vector<std::string> words_of_command(std::string_view text, std::string_view place);

// What a reader takes of one file: settings, answers, proofs. Data files have a bound of their own.
inline constexpr std::size_t kLargestTextFile = std::size_t{256} << 20;

// All bytes of a file that a user named, or of a pipe until it ends. Throws Error (bad_input) where
// it cannot be read, is longer than `largest` bytes, or is a device or pipe that gives no text:
// such a one may never end.
std::string read_file(const std::filesystem::path& file, std::size_t largest = kLargestTextFile);

// Of a file that the program looks for by itself (in a run's folder, a folder of data): nothing
// where there is no regular file of that name or it cannot be read. Throws where it is too long.
std::optional<std::string> read_file_if_there(const std::filesystem::path& file);
// The same for what is read line by line, whatever its length: a stream that has failed where there
// is no such file.
std::ifstream open_file_if_there(const std::filesystem::path& file);

}  // namespace tribench
