// SPDX-License-Identifier: MIT
#include "foundation/output_file.hpp"

#include <fstream>
#include <system_error>

#include "foundation/error.hpp"

namespace tribench {

void write_file(const std::filesystem::path& file, std::string_view text) {
  std::filesystem::path partial = file;
  partial += ".partial";
  {
    std::ofstream out(partial, std::ios::binary | std::ios::trunc);
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    out.flush();
    if (!out) {
      throw Error(ErrorKind::failed, "cannot be written", file.string(),
                  "check the disk's free space and the folder's rights");
    }
  }
  std::error_code error;
  std::filesystem::rename(partial, file, error);
  if (error) throw Error(ErrorKind::failed, error.message(), file.string());
}

}  // namespace tribench
