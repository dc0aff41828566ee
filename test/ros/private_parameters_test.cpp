#include "ros/private_parameters.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace virtual_work_dynamics {
namespace {

using XmlRpc::XmlRpcValue;

void expectRefused(const std::function<void()>& read, const std::string& message) {
  try {
    read();
    ADD_FAILURE() << "not refused: " << message;
  } catch (const ParameterError& error) {
    EXPECT_EQ(std::string(error.what()), message);
  }
}

XmlRpcValue list(const std::vector<XmlRpcValue>& values) {
  XmlRpcValue list;
  list.setSize(static_cast<int>(values.size()));
  for (int i = 0; i < list.size(); ++i) list[i] = values[static_cast<std::size_t>(i)];
  return list;
}

TEST(PrivateParameters, AreTheFallbackWhenNotSet) {
  PrivateParameters parameters{XmlRpcValue()};
  EXPECT_FALSE(parameters.has("rate"));
  EXPECT_EQ(parameters.number("rate", 2.5), 2.5);
  EXPECT_EQ(parameters.integer("window", 9), 9);
  EXPECT_TRUE(parameters.boolean("loop", true));
  EXPECT_EQ(parameters.text("law", "cosine"), "cosine");
  EXPECT_EQ(parameters.numbers("list", {1, 2}), (std::vector<double>{1, 2}));
  EXPECT_EQ(parameters.texts("names", {"a"}), (std::vector<std::string>{"a"}));
  EXPECT_FALSE(parameters.raw("scene").valid());
  EXPECT_NO_THROW(parameters.refuseUnknown());
}

TEST(PrivateParameters, AreReadByType) {
  XmlRpcValue tree;
  tree["rate"] = 12.5;
  tree["count"] = 3;
  tree["loop"] = true;
  tree["law"] = "table";
  tree["list"] = list({1, 2.5, "3e2"});
  tree["names"] = list({"a", "b"});
  PrivateParameters parameters(tree);
  EXPECT_TRUE(parameters.has("rate"));
  EXPECT_EQ(parameters.number("rate", 0), 12.5);
  EXPECT_EQ(parameters.number("count", 0), 3);
  EXPECT_EQ(parameters.integer("count", 0), 3);
  EXPECT_TRUE(parameters.boolean("loop", false));
  EXPECT_EQ(parameters.text("law", ""), "table");
  EXPECT_EQ(parameters.numbers("list"), (std::vector<double>{1, 2.5, 300}));
  EXPECT_EQ(parameters.texts("names"), (std::vector<std::string>{"a", "b"}));
  EXPECT_NO_THROW(parameters.refuseUnknown());
}

TEST(PrivateParameters, NumericStringsAreNumbers) {
  XmlRpcValue tree;
  tree["stiffness"] = "1e9";
  tree["window"] = "1e1";
  PrivateParameters parameters(tree);
  EXPECT_EQ(parameters.number("stiffness", 0), 1e9);
  EXPECT_EQ(parameters.integer("window", 0), 10);
}

TEST(PrivateParameters, NestedNamesWork) {
  XmlRpcValue tree;
  tree["estimator"]["window"] = 5;
  tree["estimator"]["inner"]["order"] = 2;
  PrivateParameters parameters(tree);
  EXPECT_EQ(parameters.integer("estimator/window", 0), 5);
  EXPECT_EQ(parameters.integer("estimator/inner/order", 0), 2);
  EXPECT_EQ(parameters.integer("estimator/lag", 4), 4);
  EXPECT_EQ(parameters.integer("estimator/window/deeper", 7), 7);
  EXPECT_NO_THROW(parameters.refuseUnknown());
}

TEST(PrivateParameters, WrongTypesAreNamed) {
  XmlRpcValue tree;
  tree["rate"] = "fast";
  tree["flag"] = 1;
  tree["law"] = 4.25;
  tree["window"] = 2.5;
  tree["huge"] = 1e10;
  tree["bad"] = std::numeric_limits<double>::infinity();
  tree["list"] = list({1, true});
  tree["names"] = list({"a", 2});
  tree["map"]["a"] = 1;
  PrivateParameters p(tree);
  expectRefused([&] { p.number("rate", 0); },
                "parameter ~rate: expected a number, got the text 'fast'");
  expectRefused([&] { p.boolean("flag", false); },
                "parameter ~flag: expected true or false, got the number 1");
  expectRefused([&] { p.text("law", ""); }, "parameter ~law: expected text, got the number 4.25");
  expectRefused([&] { p.integer("window", 0); },
                "parameter ~window: expected an integer, got the number 2.5");
  expectRefused([&] { p.integer("huge", 0); },
                "parameter ~huge: expected an integer, got the number 1e+10");
  expectRefused([&] { p.number("bad", 0); },
                "parameter ~bad: expected a finite number, got the number inf");
  expectRefused([&] { p.numbers("list"); },
                "parameter ~list[1]: expected a finite number, got the boolean true");
  expectRefused([&] { p.numbers("rate"); },
                "parameter ~rate: expected a list of numbers, got the text 'fast'");
  expectRefused([&] { p.texts("names"); }, "parameter ~names[1]: expected text, got the number 2");
  expectRefused([&] { p.texts("law"); },
                "parameter ~law: expected a list of texts, got the number 4.25");
  expectRefused([&] { p.number("map", 0); }, "parameter ~map: expected a finite number, got a map");
  expectRefused([] { PrivateParameters{XmlRpcValue(3)}; },
                "expected a map of parameters, got the number 3");
}

TEST(PrivateParameters, UnknownOnesAreRefusedByName) {
  XmlRpcValue tree;
  tree["rate"] = 1;
  tree["ratee"] = 1;
  tree["estimator"]["window"] = 5;
  tree["estimator"]["windw"] = 5;
  tree["other"]["deep"] = 5;
  PrivateParameters parameters(tree);
  parameters.number("rate", 0);
  parameters.integer("estimator/window", 0);
  expectRefused([&] { parameters.refuseUnknown(); },
                "unknown parameters ~estimator/windw (did you mean ~estimator/window?), ~other, "
                "~ratee (did you mean ~rate?); known are estimator/window, rate");
  parameters.expect("other");
  parameters.expect("ratee");
  expectRefused([&] { parameters.refuseUnknown(); },
                "unknown parameter ~estimator/windw (did you mean ~estimator/window?); known are "
                "estimator/window, other, rate, ratee");
}

TEST(PrivateParameters, NamesAndTextsOfOthersStayInTheirLine) {
  XmlRpcValue tree;
  tree["ra\nte\x1b"] = 1;
  tree["rate"] = std::string("fa\nst") + std::string(500, 't');
  PrivateParameters parameters(tree);
  expectRefused(
      [&] { parameters.number("rate", 0); },
      "parameter ~rate: expected a number, got the text 'fa\\nst" + std::string(55, 't') + "...'");
  expectRefused([&] { parameters.refuseUnknown(); },
                "unknown parameter ~ra\\nte\\x1b (did you mean ~rate?); known are rate");
}

TEST(PrivateParameters, ValueInPlaceOfAGroupIsUnknown) {
  XmlRpcValue tree;
  tree["estimator"] = 5;
  PrivateParameters parameters(tree);
  EXPECT_EQ(parameters.integer("estimator/window", 9), 9);
  expectRefused([&] { parameters.refuseUnknown(); },
                "unknown parameter ~estimator (did you mean ~estimator/window?); known are "
                "estimator/window");
}

TEST(PrivateParameters, RawCoversEverythingBelow) {
  XmlRpcValue tree;
  tree["scene"]["gravity"] = list({0, 0, -9.81});
  tree["scene"]["deep"]["er"] = 1;
  PrivateParameters parameters(tree);
  const XmlRpcValue scene = parameters.raw("scene");
  ASSERT_EQ(scene.getType(), XmlRpcValue::TypeStruct);
  EXPECT_EQ(numbersOf(scene["gravity"], "scene/gravity"), (std::vector<double>{0, 0, -9.81}));
  EXPECT_NO_THROW(parameters.refuseUnknown());
}

TEST(PrivateParameters, LookingIsNotReading) {
  XmlRpcValue tree;
  tree["rate"] = 1;
  const PrivateParameters parameters(tree);
  EXPECT_TRUE(parameters.has("rate"));
  expectRefused([&] { parameters.refuseUnknown(); }, "unknown parameter ~rate; known are");
}

}  // namespace
}  // namespace virtual_work_dynamics
