// SPDX-License-Identifier: MIT
#include "foundation/json_text.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ctime>
#include <sstream>
#include <string>
#include <vector>

#include "foundation/error.hpp"

namespace tribench {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::ordered_json;

std::string nested(int levels) { return std::string(levels, '[') + std::string(levels, ']'); }

TEST(JsonText, RefusesWhatNestsTooDeepWithoutRunningOutOfStack) {
  EXPECT_FALSE(read_json<Json>(nested(kMaxJsonDepth)).is_discarded());
  std::string objects;
  for (int i = 0; i < 100'000; ++i) objects += "{\"a\":";
  for (const std::string& text : {nested(kMaxJsonDepth + 1), nested(1'000'000), objects}) {
    std::string reason;
    EXPECT_TRUE(read_json<Json>(text, &reason).is_discarded());
    EXPECT_EQ(reason, "JSON nested deeper than 64 levels");
  }
}

// Twice the keys took four times as long.
TEST(JsonText, AnObjectOfManyKeysIsReadInTime) {
  std::string text = "{\"a\":{\"b\":1}";
  for (int i = 0; i < 100'000; ++i) {
    text += ',';
    text += write_json(Json("k" + std::to_string(i))) + ":" + std::to_string(i);
  }
  text += ",\"z\":{}}";
  const std::clock_t begin = std::clock();
  const Json object = read_json<Json>(text);
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 5);
  ASSERT_EQ(object.size(), 100'002U);
  const auto& members = object.get_ref<const Json::object_t&>();
  EXPECT_EQ(members.front().first, "a");
  EXPECT_EQ((members.begin() + 4)->first, "k3");
  EXPECT_EQ((members.begin() + 4)->second, Json(3));
  EXPECT_EQ((members.begin() + 99'999)->second, Json(99'998));
  EXPECT_EQ(members.back().first, "z");
}

// Twice the objects took four times as long.
TEST(JsonText, ALongListOfObjectsIsReadInTime) {
  std::string text = "[{\"a\":[1]}";
  for (int i = 0; i < 200'000; ++i) text += ",{\"a\":[1]}";
  const std::clock_t begin = std::clock();
  EXPECT_EQ(read_json<Json>(text + "]").size(), 200'001U);
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 5);
}

TEST(JsonText, EveryKindOfValueIsReadAsItIs) {
  const std::string text =
      R"({"n":null,"t":true,"i":-7,"u":18446744073709551615,"d":0.25,"s":"a","l":[[],{},[1,{"k":2}]],"o":{"z":1,"a":2}})";
  EXPECT_EQ(write_json(read_json<Json>(text)), text);
  EXPECT_EQ(read_json<nlohmann::json>(text), nlohmann::json::parse(text));
  EXPECT_EQ(read_json<Json>("7"), Json(7));
}

TEST(JsonText, SaysWhereItIsNoJsonInPrintableText) {
  std::string reason;
  EXPECT_TRUE(read_json<Json>("{\"a\": 1,\n \"b\": \"\xff\"}", &reason).is_discarded());
  EXPECT_EQ(reason, "no JSON at line 2, column 8");
  EXPECT_TRUE(read_json<Json>("", &reason).is_discarded());
  EXPECT_EQ(reason, "no JSON at line 1, column 1");
  EXPECT_TRUE(read_json<Json>("[1e999]", &reason).is_discarded());
  EXPECT_TRUE(read_json<Json>("{\"a\":\n [1, -Infinity]}", &reason).is_discarded());
  EXPECT_EQ(reason, "no JSON at line 2, column 7 (Infinity)");
  EXPECT_TRUE(read_json<Json>("[nan]", &reason).is_discarded());
  EXPECT_THAT(reason, HasSubstr("(nan)"));
  EXPECT_THROW(read_json_or_throw<Json>("{", "a file"), Error);
  EXPECT_EQ(read_json_or_throw<Json>("[1, 2]", "a file").size(), 2U);
}

// The last one would have been taken, without a word.
TEST(JsonText, AKeyThatStandsTwiceInOneObjectIsNamed) {
  const auto reason_of = []<typename AnyJson>(const std::string& text, AnyJson) {
    std::string reason;
    EXPECT_TRUE(read_json<AnyJson>(text, &reason).is_discarded());
    return reason;
  };
  std::string many = "[{\"x\":{";
  for (int i = 0; i < 100'000; ++i) many += fmt::format("\"k{}\":{},", i, i);
  many += "\"k77\":0}}]";
  for (const std::string& reason : {reason_of(many, Json()), reason_of(many, nlohmann::json())}) {
    EXPECT_EQ(reason, "the key \"k77\" stands twice in one object");
  }
  EXPECT_EQ(reason_of("{\"a\":1,\"\\u0061\":1}", Json()),
            "the key \"a\" stands twice in one object");
  EXPECT_EQ(reason_of("{\"\\n\":1,\"\\n\":1}", Json()),
            "the key \"\\n\" stands twice in one object");
  EXPECT_FALSE(read_json<Json>("[{\"a\":{\"a\":1}},{\"a\":1}]").is_discarded());
}

// The objects among what a program prints, "!" for one that cannot be read.
std::vector<std::string> objects_in(const std::string& text) {
  std::vector<std::string> found;
  for (std::size_t at = find_json_object(text, 0); at < text.size();
       at = find_json_object(text, at)) {
    const Json object = read_json_at<Json>(text, at);
    found.push_back(object.is_discarded() ? "!" : write_json(object));
  }
  return found;
}

TEST(JsonText, FindsObjectsAmongChatterOnOneLineOrSeveral) {
  using Found = std::vector<std::string>;
  EXPECT_EQ(objects_in("go\n {\"a\": 1} is it\n{\n\"b\":\n{\n\"c\": \"}\"}\n}\nnot {\"d\": 2}\n"),
            (Found{"{\"a\":1}", "{\"b\":{\"c\":\"}\"}}"}));
  EXPECT_EQ(objects_in("{ begins\n{\"a\": 1}\n{'b': 2}\n{\"c\": [NaN,\n1]}\n{"),
            (Found{"!", "{\"a\":1}", "!", "!", "!"}));
  EXPECT_EQ(objects_in(""), Found{});
  std::string chatter;
  for (int i = 0; i < 50'000; ++i) chatter += "{\n";
  EXPECT_FALSE(objects_in(chatter).empty()) << "in time";
}

// The parser takes a NUL byte for the end of the text.
TEST(JsonText, NothingStandsBehindANulByte) {
  std::string reason;
  const std::string text("{\"a\": 1}\n\0{\"b\"", 14);
  EXPECT_TRUE(read_json<Json>(text, &reason).is_discarded());
  EXPECT_NE(reason.find("a NUL byte, which JSON has not, at line 2"), std::string::npos) << reason;
}

TEST(JsonText, AComplaintIsInWordsAndNotInTheLibrarysNumbers) {
  const auto complaint = [](const char* text) {
    try {
      read_json<Json>(text).at("a").at("b");
    } catch (const nlohmann::detail::exception& error) {
      return json_complaint(error);
    }
    return std::string();
  };
  EXPECT_EQ(complaint("{}"), "key 'a' not found");
  EXPECT_EQ(complaint("{\"a\": [1]}"), "cannot use at() with array");
}

TEST(JsonText, ANumberIsWholeWhereItsTypeHoldsIt) {
  const auto held = [](const char* text) { return json_whole_number<int>(read_json<Json>(text)); };
  EXPECT_EQ(held("7"), 7);
  EXPECT_EQ(held("-7"), -7);
  for (const char* other : {"2147483648", "-2147483649", "99999999999999999999", "1e77", "7.0",
                            "2.5", "\"7\"", "null", "true"}) {
    EXPECT_EQ(held(other), std::nullopt) << other;
  }
  EXPECT_EQ(json_whole_number<std::uint64_t>(read_json<Json>("18446744073709551615")),
            18446744073709551615U);
  EXPECT_EQ(json_whole_number<std::uint64_t>(read_json<Json>("-1")), std::nullopt);
}

TEST(JsonText, WritesBytesThatAreNoUtf8AsTheReplacementCharacter) {
  EXPECT_EQ(write_json(Json({{"a", "\xff"}})), "{\"a\":\"\xef\xbf\xbd\"}");
}

}  // namespace
}  // namespace tribench
