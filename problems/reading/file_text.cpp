// SPDX-License-Identifier: MIT
#include "problems/reading/file_text.hpp"

#include <zlib.h>

#include <algorithm>
#include <fstream>
#include <limits>

#include "foundation/error.hpp"

namespace tribench {
namespace {

constexpr std::size_t kLargestText = std::size_t{16} << 30;

std::string read_bytes(const std::filesystem::path& file) {
  std::error_code code;
  if (std::filesystem::is_directory(file, code)) {
    throw_bad_input("this is a folder", file.string(), "give a CSV file");
  }
  std::ifstream in(file, std::ios::binary);
  if (!in) throw_bad_input("cannot read the file", file.string(), "check the path");
  std::string text;
  // A pipe has no size: what is there is read until it ends.
  const std::uintmax_t size = std::filesystem::file_size(file, code);
  std::size_t filled = 0;
  text.resize(code ? 0 : static_cast<std::size_t>(size) + 1);
  while (true) {
    if (filled == text.size()) text.resize(std::max<std::size_t>(2 * filled, 65536));
    in.read(text.data() + filled, static_cast<std::streamsize>(text.size() - filled));
    filled += static_cast<std::size_t>(in.gcount());
    if (!in) break;
  }
  if (in.bad()) throw Error(ErrorKind::failed, "reading stopped half way", file.string());
  text.resize(filled);
  return text;
}

std::string unpacked(const std::string& packed, const std::string& file) {
  z_stream stream = {};
  constexpr int kGzip = 16 + MAX_WBITS;
  if (inflateInit2(&stream, kGzip) != Z_OK) {
    throw Error(ErrorKind::failed, "cannot unpack the file", file);
  }
  std::string text;
  std::size_t read = 0;
  std::size_t filled = 0;
  int status = Z_OK;
  const auto piece = [](std::size_t bytes) {
    return static_cast<uInt>(std::min<std::size_t>(bytes, std::numeric_limits<int>::max()));
  };
  while (true) {
    if (filled == text.size()) text.resize(std::max<std::size_t>(2 * filled, 4 * packed.size()));
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + read));
    stream.avail_in = piece(packed.size() - read);
    stream.next_out = reinterpret_cast<Bytef*>(text.data() + filled);
    stream.avail_out = piece(text.size() - filled);
    const std::size_t in_before = stream.avail_in;
    const std::size_t out_before = stream.avail_out;
    status = inflate(&stream, Z_NO_FLUSH);
    read += in_before - stream.avail_in;
    filled += out_before - stream.avail_out;
    if (status == Z_STREAM_END && read < packed.size()) {
      inflateReset(&stream);  // several members in one file
      continue;
    }
    if (status != Z_OK || filled > kLargestText) break;
    if (read == packed.size() && stream.avail_out > 0) break;
  }
  inflateEnd(&stream);
  if (filled > kLargestText) {
    throw_bad_input("it unpacks to more than 16 GiB", file, "give a part of it");
  }
  if (status != Z_STREAM_END) {
    throw_bad_input("the gzip file is damaged or cut off", file, "pack it again, or unpack it");
  }
  text.resize(filled);
  return text;
}

}  // namespace

std::string read_file_text(const std::filesystem::path& file) {
  std::string text = read_bytes(file);
  if (text.starts_with("\x1F\x8B")) return unpacked(text, file.string());
  return text;
}

}  // namespace tribench
