// SPDX-License-Identifier: MIT
#include "algorithms/udsr/weights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "foundation/error.hpp"
#include "foundation/json_text.hpp"

namespace tribench::udsr {
namespace {

using Json = nlohmann::ordered_json;
constexpr const char* kFormat = "tribench udsr policy";

// The file's own blocks, in the layout of a policy over the file's tokens.
struct Stored {
  std::vector<std::string> tokens;
  std::size_t operations = 0;
  Eigen::VectorXd parameters;
};

constexpr const char* kMend = "make one with: tribench pretrain --out FILE";

Json in_single_precision(const Eigen::VectorXd& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(static_cast<float>(value));
  return list;
}

Eigen::VectorXd read_numbers(const Json& list) {
  const auto values = list.get<std::vector<float>>();
  Eigen::VectorXd result(static_cast<Eigen::Index>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) {
    result[static_cast<Eigen::Index>(i)] = static_cast<double>(values[i]);
  }
  return result;
}

std::optional<std::size_t> place_of(const std::vector<std::string>& names,
                                    const std::string& name) {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

[[noreturn]] void throw_damaged(std::string_view what, std::string_view place) {
  throw_bad_input(fmt::format("the weight file is damaged: {}", what), place, kMend);
}

// What `read` reads of a file; a value of another type than it has to be is a damage.
template <typename Read>
auto undamaged(std::string_view place, const Read& read) {
  try {
    return read();
  } catch (const Json::exception&) {
    throw_damaged("a value is not of its type", place);
  }
}

template <typename Whole>
Whole count_in(const Json& file, const char* key, std::string_view place) {
  const auto count = json_whole_number<Whole>(file.at(key));
  if (!count) throw_damaged("a value is not of its type", place);
  return *count;
}

// A weight file whose hash matches. Throws Json::exception where a value is of another type.
Json parse_checked(std::string_view text, std::string_view place) {
  std::string reason;
  Json file = read_json<Json>(text, &reason);
  if (file.is_discarded()) {
    throw_bad_input("this is not a policy's weight file: " + reason, place, kMend);
  }
  if (!file.is_object() || file.value("format", "") != kFormat) {
    throw_bad_input("this is not a policy's weight file", place, kMend);
  }
  const auto version = count_in<int>(file, "version", place);
  if (version != kWeightsVersion && version != kWeightsVersionWithEncoder) {
    throw_bad_input(fmt::format("weight files of version {} are not read, only versions {} and {}",
                                version, kWeightsVersion, kWeightsVersionWithEncoder),
                    place, kMend);
  }
  if (!file.contains("tokens") || !file.contains("parameters") || !file.contains("operations") ||
      file.contains("encoder") != (version == kWeightsVersionWithEncoder) ||
      file.value("hash", "") !=
          weights_hash(file["tokens"], file["parameters"], file.value("encoder", Json()))) {
    throw_damaged("its hash does not match", place);
  }
  return file;
}

Stored parse_stored(std::string_view text, std::string_view place) {
  return undamaged(place, [&]() -> Stored {
    const Json file = parse_checked(text, place);
    return {file["tokens"].get<std::vector<std::string>>(),
            count_in<std::size_t>(file, "operations", place), read_numbers(file["parameters"])};
  });
}

// Copies the blocks, column by column and row by row where both sides know the token.
class Transfer {
 public:
  Transfer(const Stored& from, Policy& to)
      : from_(from), to_(to), hidden_(Policy::kHidden), at_(to.shape().layout()) {
    const auto inputs = static_cast<Eigen::Index>(from.operations + from.tokens.size() + 2);
    from_recurrent_ = 4 * hidden_ * inputs;
    from_bias_ = from_recurrent_ + 4 * hidden_ * hidden_;
    from_output_ = from_bias_ + 4 * hidden_;
    from_output_bias_ = from_output_ + outputs() * hidden_;
  }

  bool fits() const { return from_.parameters.size() == from_output_bias_ + outputs(); }

  void run() {
    const TokenLibrary& library = to_.library();
    to_.parameters().segment(at_.recurrent, 4 * hidden_ * hidden_ + 4 * hidden_) =
        from_.parameters.segment(from_recurrent_, 4 * hidden_ * hidden_ + 4 * hidden_);
    copy_input(static_cast<Eigen::Index>(from_.operations), to_.shape().parent_column(-1));
    copy_input(static_cast<Eigen::Index>(from_.operations + 1 + from_.tokens.size()),
               to_.shape().sibling_column(-1));
    for (std::size_t i = 0; i < library.size(); ++i) {
      const auto id = static_cast<TokenId>(i);
      const auto found = place_of(from_.tokens, library[id].name);
      if (!found) continue;
      const auto source = static_cast<Eigen::Index>(*found);
      if (library.is_operation(id))
        copy_input(source, to_.shape().parent_column(static_cast<int>(i)));
      copy_input(static_cast<Eigen::Index>(from_.operations) + 1 + source,
                 to_.shape().sibling_column(static_cast<int>(i)));
      copy_output(source, static_cast<Eigen::Index>(i));
    }
  }

 private:
  Eigen::Index outputs() const { return static_cast<Eigen::Index>(from_.tokens.size()); }

  void copy_input(Eigen::Index from, Eigen::Index to) {
    to_.parameters().segment(at_.input + 4 * hidden_ * to, 4 * hidden_) =
        from_.parameters.segment(4 * hidden_ * from, 4 * hidden_);
  }
  void copy_output(Eigen::Index from, Eigen::Index to) {
    for (Eigen::Index h = 0; h < hidden_; ++h) {
      to_.parameters()[at_.output + h * to_.shape().outputs() + to] =
          from_.parameters[from_output_ + h * outputs() + from];
    }
    to_.parameters()[at_.output_bias + to] = from_.parameters[from_output_bias_ + from];
  }

  const Stored& from_;
  Policy& to_;
  Eigen::Index hidden_;
  PolicyShape::Layout at_;
  Eigen::Index from_recurrent_ = 0;
  Eigen::Index from_bias_ = 0;
  Eigen::Index from_output_ = 0;
  Eigen::Index from_output_bias_ = 0;
};

}  // namespace

std::string weights_hash(const Json& tokens, const Json& parameters, const Json& encoder) {
  return fmt::format("{:016x}", key_of(write_json(tokens) + write_json(parameters) +
                                       (encoder.is_null() ? "" : write_json(encoder))));
}

std::string write_weights(const Policy& policy, const DataEncoder* encoder,
                          const WeightsProvenance& provenance) {
  const TokenLibrary& library = policy.library();
  Json tokens = Json::array();
  for (std::size_t i = 0; i < library.size(); ++i) {
    tokens.push_back(library[static_cast<TokenId>(i)].name);
  }
  Json parameters = in_single_precision(policy.parameters());
  Json encoding;
  if (encoder != nullptr) encoding = in_single_precision(encoder->parameters());
  Json file;
  file["format"] = kFormat;
  file["version"] = encoder == nullptr ? kWeightsVersion : kWeightsVersionWithEncoder;
  file["provenance"] = {{"command", provenance.command},
                        {"seed", provenance.seed},
                        {"sequences", provenance.sequences},
                        // No more digits than hold on every machine: the file is the same on all.
                        {"loss_per_token", std::round(1e6 * provenance.loss_per_token) / 1e6}};
  file["hash"] = weights_hash(tokens, parameters, encoding);
  file["operations"] = library.operations();
  file["tokens"] = std::move(tokens);
  file["parameters"] = std::move(parameters);
  if (encoder != nullptr) file["encoder"] = std::move(encoding);
  return write_json(file) + "\n";
}

void read_weights(std::string_view text, std::string_view place, Policy& policy) {
  const Stored stored = parse_stored(text, place);
  Transfer transfer(stored, policy);
  if (!transfer.fits()) {
    throw_bad_input("the weight file does not have as many parameters as its tokens need", place,
                    kMend);
  }
  transfer.run();
}

DataEncoder read_encoder(std::string_view text, std::string_view place) {
  const std::string mend = "make one with: tribench pretrain --encoder --out FILE";
  Eigen::VectorXd stored = undamaged(place, [&] {
    const Json file = parse_checked(text, place);
    if (!file.contains("encoder")) {
      throw_bad_input("the weight file has no data encoder", place, mend);
    }
    return read_numbers(file["encoder"]);
  });
  DataEncoder encoder(RandomStream(0));
  if (stored.size() != DataEncoder::size()) {
    throw_bad_input("the weight file's data encoder has another size", place, mend);
  }
  encoder.parameters() = std::move(stored);
  return encoder;
}

}  // namespace tribench::udsr
