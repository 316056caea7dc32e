// SPDX-License-Identifier: MIT
//
// A data file's text in UTF-8 (text_encoding.hpp): unpacked where it is gzip, told by its first
// bytes, not by its name.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace tribench {

// What any packed file may open to; beyond that it is 100 times its packed size, 16 GiB at most. A
// recording packs to a tenth or a thirtieth, what was made to fill the memory to a thousandth.
inline constexpr std::size_t kOpensAlways = std::size_t{1} << 30;

// Throws Error: bad_input where the file cannot be read, is no text (foreign_formats.hpp) or its
// packing is damaged or opens to more than that; failed where reading stops half way.
// `opens_always` for tests.
std::string read_file_text(const std::filesystem::path& file,
                           std::size_t opens_always = kOpensAlways);

}  // namespace tribench
