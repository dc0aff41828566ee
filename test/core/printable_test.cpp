#include "base/printable.h"

#include <gtest/gtest.h>

namespace virtual_work_dynamics {
namespace {

TEST(Printable, ControlCharactersStandAsEscapes) {
  EXPECT_EQ(printable("arm_1"), "arm_1");
  EXPECT_EQ(printable("a\nb\tc\rd"), "a\\nb\\tc\\rd");
  EXPECT_EQ(printable("\x1b[31mred\x7f"), "\\x1b[31mred\\x7f");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("it's 100 % \\ done"), "it's 100 % \\ done");
}

TEST(Printable, LettersOfAllLanguagesStay) {
  EXPECT_EQ(printable("H\xc3\xbc"
                      "fte \xe5\x8f\xb3 \xf0\x9f\xa4\x96"),
            "H\xc3\xbc"
            "fte \xe5\x8f\xb3 \xf0\x9f\xa4\x96");
}

TEST(Printable, WhatTurnsOrBreaksALineIsShown) {
  EXPECT_EQ(printable("a\xe2\x80\xae"
                      "b"),
            "a\\u202eb");  // right-to-left override
  EXPECT_EQ(printable("a\xe2\x80\xa8"
                      "b"),
            "a\\u2028b");  // line separator
  EXPECT_EQ(printable("a\xc2\x85"
                      "b"),
            "a\\u0085b");  // next line
  EXPECT_EQ(printable("a\xe2\x80\x8b"
                      "b"),
            "a\\u200bb");  // blank of no width
}

TEST(Printable, BytesThatAreNotUtf8AreShown) {
  EXPECT_EQ(printable("H\xfc"
                      "fte"),
            "H\\xfcfte");                 // Latin-1
  EXPECT_EQ(printable("\xc3"), "\\xc3");  // cut off
  EXPECT_EQ(printable("\xe5\x8f"), "\\xe5\\x8f");
  EXPECT_EQ(printable("\xe5 ok"), "\\xe5 ok");
  EXPECT_EQ(printable("\xc0\x8a"), "\\xc0\\x8a");           // an overlong line end
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");  // half of a surrogate pair
  EXPECT_EQ(printable("\xf5\x80\x80\x80\xff"), "\\xf5\\x80\\x80\\x80\\xff");
}

TEST(Printable, NamesAreCutBetweenCharacters) {
  EXPECT_EQ(inQuotes("arm"), "'arm'");
  EXPECT_EQ(inQuotes(""), "''");
  EXPECT_EQ(inQuotes(std::string(60, 'a')), "'" + std::string(60, 'a') + "'");
  EXPECT_EQ(inQuotes(std::string(61, 'a')), "'" + std::string(60, 'a') + "...'");
  std::string umlauts = "a";
  for (int i = 0; i < 40; ++i) umlauts += "\xc3\xbc";
  EXPECT_EQ(inQuotes(umlauts), "'" + umlauts.substr(0, 59) + "...'");
}

TEST(Printable, ListsAreCutAfterAFewNames) {
  EXPECT_EQ(namesInQuotes({}), "none");
  EXPECT_EQ(namesInQuotes({"a"}), "'a'");
  EXPECT_EQ(namesInQuotes({"a", "b", "c"}), "'a', 'b' and 'c'");
  std::vector<std::string> names;
  for (int i = 0; i < 100; ++i) names.push_back("j" + std::to_string(i));
  EXPECT_EQ(namesInQuotes(names),
            "'j0', 'j1', 'j2', 'j3', 'j4', 'j5', 'j6', 'j7', 'j8', 'j9', 'j10', 'j11' and 88 more");
}

}  // namespace
}  // namespace virtual_work_dynamics
