// SPDX-License-Identifier: MIT
//
// Pre-trained policies as files: versioned JSON with the names of the tokens, the parameters, a
// hash over both and where they came from; version 2 holds a data encoder besides. A policy for
// fewer tokens takes the rows and columns that it needs, by name.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "algorithms/udsr/data_encoder.hpp"
#include "algorithms/udsr/policy.hpp"

namespace tribench::udsr {

inline constexpr int kWeightsVersion = 1;
inline constexpr int kWeightsVersionWithEncoder = 2;

// Where a file's parameters came from, for the reader of the file.
struct WeightsProvenance {
  std::string command;
  std::uint64_t seed = 0;
  std::uint64_t sequences = 0;
  double loss_per_token = 0;  // nats, on held-out sequences
};

// What stands under "hash" in a file of this content; encoder: null where there is none.
std::string weights_hash(const nlohmann::ordered_json& tokens,
                         const nlohmann::ordered_json& parameters,
                         const nlohmann::ordered_json& encoder);

// encoder: null where there is none.
std::string write_weights(const Policy& policy, const DataEncoder* encoder,
                          const WeightsProvenance& provenance);

// Fills `policy` from a file's text. place: the file's name, for errors. Throws Error (bad_input)
// where the text is not such a file, its version is another, or its hash does not match.
void read_weights(std::string_view text, std::string_view place, Policy& policy);

// The encoder of the same file. Throws as above, and where the file has none.
DataEncoder read_encoder(std::string_view text, std::string_view place);

}  // namespace tribench::udsr

namespace tribench::embedded {

// The weights shipped with the program: weights.json, byte for byte what `tribench pretrain` writes
// with its defaults.
std::string_view udsr_weights();

}  // namespace tribench::embedded
