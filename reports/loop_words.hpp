// SPDX-License-Identifier: MIT
//
// The closed loop's findings in plain words, shared by loop.md and loop.html, and the careful
// reading of loop.json that both need: a value that is absent or of another kind is missing, never
// an exception.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace tribench {

// NaN where the key is absent or no number.
double number_of(const nlohmann::json& object, const char* key);
double element_of(const nlohmann::json& array, std::size_t i);
// Empty where the key is absent; a number is printed.
std::string text_of(const nlohmann::json& object, const char* key);

// An empty array or object where the key is absent or of another kind.
nlohmann::json items_of(const nlohmann::json& object, const char* key);
nlohmann::json member_of(const nlohmann::json& object, const char* key);
bool flag_of(const nlohmann::json& object, const char* key);

// "load_coulomb" -> "load-dependent Coulomb friction"; an unknown family is returned as it is.
std::string family_words(std::string_view family);
// "R3" -> "two postures or a known payload (R3)"; the movements of closing the loop.
std::string movement_words(std::string_view request);
// "mu = 0.034 (0.031 .. 0.037)".
std::string parameters_of(const nlohmann::json& effect);

// "52 .. 100 % (95 %: 49 .. 55 at least)" of an `error` object; empty where not known.
std::string closed_share(const nlohmann::json& error);

std::string verdict_sentence(const nlohmann::json& loop);
// What, how large, how sure, what else it could be, which movement would settle it.
std::string effect_sentence(const nlohmann::json& effect, const nlohmann::json& loop);
// Empty where nothing was left over.
std::string leftover_sentence(const nlohmann::json& loop);

// What the data cannot show, cannot tell apart, and the bursts left out: one line each.
std::vector<std::string> untestable_sentences(const nlohmann::json& loop);
std::vector<std::string> aliased_sentences(const nlohmann::json& loop);
std::vector<std::string> event_sentences(const nlohmann::json& loop);
// The warnings about the data, then the notes of the search.
std::vector<std::string> remarks(const nlohmann::json& loop);

}  // namespace tribench
