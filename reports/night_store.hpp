// SPDX-License-Identifier: MIT
//
// The store of a nightly job: one small file a night, never changed, and one a blessing (the night
// that others are compared with, and why). A folder anywhere, in a repository too. Files appear
// whole or not at all: a machine that dies while one is written leaves the store as it was.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "reports/night.hpp"

namespace tribench {

struct Blessing {
  std::string night;   // the name of the night that is the base from now on
  std::string reason;  // one line
  std::string when;    // UTC; orders the blessings
};

class NightStore {
 public:
  // Makes the folder where it is not there. Throws Error (failed) where it cannot be written to.
  explicit NightStore(std::filesystem::path folder);

  const std::filesystem::path& folder() const { return folder_; }
  std::filesystem::path runs() const { return folder_ / "runs"; }

  // Throws Error (bad_input) where a night of that name is there with other contents.
  void record(const Night& night);
  std::vector<std::string> names() const;  // oldest first
  // Throws Error (bad_input) where it is missing or damaged.
  Night read(const std::string& name, bool with_seeds = true) const;

  // Throws Error (bad_input) where the store does not have the night, or where `when` lies before
  // the last blessing: a clock was set back, and this one would change nothing.
  void bless(const Blessing& blessing);
  std::vector<Blessing> blessings() const;  // oldest first; throws where one is damaged
  // The night to compare with: of the last blessing. Nothing in a store without nights. Throws
  // Error (bad_input) where there are nights and no blessing, or where the blessed night is missing
  // or damaged: a base is never replaced by another.
  std::optional<Night> base() const;

  // Nights but the last `keep` and the blessed ones, which stay; removes them where `remove`.
  std::vector<std::string> prune(std::size_t keep, bool remove);

 private:
  std::filesystem::path file_of(const std::string& name) const;
  std::filesystem::path folder_;
};

}  // namespace tribench
