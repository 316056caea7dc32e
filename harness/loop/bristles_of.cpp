// SPDX-License-Identifier: MIT
#include "harness/loop/bristles_of.hpp"

namespace tribench::loop {

std::optional<Bristles> bristles_of(const Diagnosis& diagnosis, const Observations& data) {
  const std::optional<std::size_t> family = presliding_family(diagnosis.after, data);
  if (!family) return std::nullopt;
  return fit_bristles(diagnosis.after, *family, data,
                      usable_rows(data, diagnosis.held_out, false, diagnosis.masked),
                      diagnosis.noise.whitened);
}

}  // namespace tribench::loop
