// SPDX-License-Identifier: MIT
#include "problems/reading/file_text.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "foundation/error.hpp"
#include "foundation/text.hpp"
#include "problems/reading/foreign_formats.hpp"
#include "problems/reading/text_encoding.hpp"

namespace tribench {
namespace {

constexpr std::size_t kLargestText = std::size_t{16} << 30;
constexpr std::size_t kMostTimes = 100;                       // its packed size
constexpr std::size_t kLargestOfPipe = std::size_t{2} << 30;  // which may never end

std::string read_bytes(const std::filesystem::path& file) {
  std::error_code code;
  const bool has_end = std::filesystem::is_regular_file(file, code);
  return read_file(file, has_end ? kLargestText : kLargestOfPipe);
}

[[noreturn]] void refuse_unpacked(const std::string& file, std::size_t packed, std::size_t most) {
  throw_bad_input(
      fmt::format("its {} bytes unpack to more than {}, {}", packed, most,
                  most == kLargestText ? "the most that is read of one file"
                                       : "far more than a recording's (100 times its size)"),
      file,
      most == kLargestText ? "give a part of it"
                           : "where that is meant: gunzip it and give the text");
}

// Unpacks to the end, or to more than `most` bytes, handing each piece on. Returns zlib's last
// word.
template <typename Take>
int inflate_in_pieces(const std::string& packed, const std::string& file, std::size_t most,
                      Take take) {
  z_stream stream = {};
  constexpr int kGzip = 16 + MAX_WBITS;
  int status = inflateInit2(&stream, kGzip);
  if (status != Z_OK) throw Error(ErrorKind::failed, "cannot unpack the file", file);
  std::vector<char> piece(std::size_t{1} << 20);
  std::size_t read = 0;
  std::size_t unpacked = 0;
  while (unpacked <= most) {
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + read));
    stream.avail_in = static_cast<uInt>(
        std::min<std::size_t>(packed.size() - read, std::numeric_limits<int>::max()));
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = static_cast<uInt>(piece.size());
    const std::size_t in_before = stream.avail_in;
    status = inflate(&stream, Z_NO_FLUSH);
    read += in_before - stream.avail_in;
    const std::size_t made = piece.size() - stream.avail_out;
    unpacked += made;
    take(std::string_view(piece.data(), made));
    if (status == Z_STREAM_END && read < packed.size()) {
      inflateReset(&stream);  // several members in one file
      continue;
    }
    if (status != Z_OK || (read == packed.size() && stream.avail_out > 0)) break;
  }
  inflateEnd(&stream);
  return status;
}

std::string unpacked(const std::string& packed, const std::string& file, std::size_t always) {
  const std::size_t most = std::min(kLargestText, std::max(always, kMostTimes * packed.size()));
  // Twice, the first time for the size alone: what is refused then takes no memory, and what is not
  // takes what it needs and no more.
  std::size_t size = 0;
  const int status =
      inflate_in_pieces(packed, file, most, [&](std::string_view piece) { size += piece.size(); });
  if (size > most) refuse_unpacked(file, packed.size(), most);
  if (status != Z_STREAM_END) {
    throw_bad_input("the gzip file is damaged or cut off", file, "pack it again, or unpack it");
  }
  std::string text;
  text.reserve(size);
  inflate_in_pieces(packed, file, most, [&](std::string_view piece) { text += piece; });
  return text;
}

}  // namespace

std::string read_file_text(const std::filesystem::path& file, std::size_t opens_always) {
  refuse_folder(file);
  std::string text = read_bytes(file);
  if (text.starts_with("\x1F\x8B")) text = unpacked(text, file.string(), opens_always);
  refuse_foreign_bytes(text, file.string());
  text = as_utf8(std::move(text));
  // Lines that end with a carriage return alone.
  if (text.find('\n') == std::string::npos) std::ranges::replace(text, '\r', '\n');
  return text;
}

}  // namespace tribench
