// SPDX-License-Identifier: MIT
#include "problems/suite/suite.hpp"

namespace tribench {
namespace embedded {
std::string_view suite_nguyen();
std::string_view suite_livermore();
std::string_view suite_keijzer();
std::string_view suite_korns();
std::string_view suite_strogatz();
std::string_view suite_feynman();
std::string_view suite_fastsrb();
std::string_view suite_handbook();
std::string_view suite_first_principles();
std::string_view suite_srbench_blackbox();
}  // namespace embedded

namespace suite {

const std::vector<ShippedSuite>& shipped_suites() {
  static const std::vector<ShippedSuite> kSuites = {
      {"nguyen", embedded::suite_nguyen()},
      {"livermore", embedded::suite_livermore()},
      {"keijzer", embedded::suite_keijzer()},
      {"korns", embedded::suite_korns()},
      {"strogatz", embedded::suite_strogatz()},
      {"feynman", embedded::suite_feynman()},
      {"fastsrb", embedded::suite_fastsrb()},
      {"handbook", embedded::suite_handbook()},
      {"first_principles", embedded::suite_first_principles()},
      {"srbench_blackbox", embedded::suite_srbench_blackbox()}};
  return kSuites;
}

}  // namespace suite
}  // namespace tribench
