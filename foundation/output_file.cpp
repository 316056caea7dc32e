// SPDX-License-Identifier: MIT
#include "foundation/output_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "foundation/error.hpp"

namespace tribench {
namespace {

namespace fs = std::filesystem;

// Of a name that no file can have here, as opposed to a machine that has no room.
bool is_of_the_name(int error) {
  return error == ENOENT || error == ENOTDIR || error == EISDIR || error == ELOOP ||
         error == ENAMETOOLONG;
}

[[noreturn]] void throw_unwritable(const fs::path& file, int error) {
  if (is_of_the_name(error)) {
    throw_bad_input(fmt::format("cannot be written: {}", std::strerror(error)), file.string(),
                    "name a file in a folder that is there");
  }
  throw Error(ErrorKind::failed, fmt::format("cannot be written: {}", std::strerror(error)),
              file.string(), "check the disk's free space and the folder's rights");
}

// Whether all of it has arrived; errno says why not.
bool write_all(const fs::path& file, std::string_view text) {
  errno = 0;
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.flush();
  return static_cast<bool>(out);
}

// Where a link leads, also to what is not there yet.
fs::path end_of_links(fs::path file) {
  std::error_code error;
  while (fs::is_symlink(file, error)) file = file.parent_path() / fs::read_symlink(file, error);
  return file;
}

// A terminal, a pipe: stays what it is. Links in a ring and names that are too long are errors.
bool is_written_in_place(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::status_known(status)) throw_unwritable(file, error.value());
  return fs::exists(status) && !fs::is_regular_file(status);
}

// Beside its place, which is where links lead to.
fs::path write_partial(const fs::path& file, const fs::path& target, std::string_view text) {
  fs::path partial = target;
  partial += ".partial";
  if (write_all(partial, text)) return partial;
  const int why = errno;
  std::error_code error;
  fs::remove(partial, error);
  throw_unwritable(file, why);
}

}  // namespace

void write_file(const fs::path& file, std::string_view text) {
  if (is_written_in_place(file)) {
    if (!write_all(file, text)) throw_unwritable(file, errno);
    return;
  }
  const fs::path target = end_of_links(file);  // so that a link stays one
  const fs::path partial = write_partial(file, target, text);
  std::error_code error;
  fs::rename(partial, target, error);
  if (!error) return;
  const int why = error.value();
  fs::remove(partial, error);
  throw_unwritable(file, why);
}

void try_output_file(const fs::path& file) {
  if (is_written_in_place(file)) {
    if (fs::is_directory(file)) throw_unwritable(file, EISDIR);
    return;
  }
  fs::remove(write_partial(file, end_of_links(file), ""));
}

}  // namespace tribench
