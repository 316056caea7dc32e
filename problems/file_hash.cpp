// SPDX-License-Identifier: MIT
#include "problems/file_hash.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <istream>
#include <memory>
#include <sstream>

#include "foundation/error.hpp"
#include "foundation/text.hpp"

namespace tribench {
namespace {

std::string sha256_of_stream(std::istream& in, const std::string& place) {
  const std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context(EVP_MD_CTX_new(),
                                                                   EVP_MD_CTX_free);
  bool is_good = context != nullptr && EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) == 1;
  std::array<char, 65536> block{};
  while (is_good && in) {
    in.read(block.data(), block.size());
    is_good =
        EVP_DigestUpdate(context.get(), block.data(), static_cast<std::size_t>(in.gcount())) == 1;
  }
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  is_good = is_good && !in.bad() && EVP_DigestFinal_ex(context.get(), digest.data(), &size) == 1;
  if (!is_good) throw Error(ErrorKind::failed, "cannot hash the file", place);
  std::string text;
  for (unsigned int i = 0; i < size; ++i) text += fmt::format("{:02x}", digest[i]);
  return text;
}

}  // namespace

std::string sha256_of(const std::filesystem::path& file) {
  std::ifstream in = open_file_if_there(file);
  if (!in) throw_bad_input("this is no file that can be read", file.string(), "check the path");
  return sha256_of_stream(in, file.string());
}

std::string sha256_of_text(std::string_view text) {
  std::istringstream in{std::string(text)};
  return sha256_of_stream(in, {});
}

}  // namespace tribench
