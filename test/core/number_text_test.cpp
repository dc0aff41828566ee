#include "base/number_text.h"

#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "base/number_text_portable.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kLargest = std::numeric_limits<double>::max();
constexpr double kSmallestNormal = std::numeric_limits<double>::min();
constexpr double kSmallest = std::numeric_limits<double>::denorm_min();

// Both ways of reading and writing numbers, whichever of them the library uses here.
struct Way {
  std::string name;
  void (*append)(std::string&, double);
  bool (*parse)(const std::string&, double&);
};

class NumberText : public testing::TestWithParam<Way> {
 protected:
  static std::string text(double value) {
    std::string result;
    GetParam().append(result, value);
    return result;
  }
  static bool parses(const std::string& number) {
    double value = 0;
    return GetParam().parse(number, value);
  }
  static double parsed(const std::string& number) {
    double value = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(GetParam().parse(number, value)) << "'" << number << "'";
    return value;
  }
};

// Reads with the C++ stream library, which shares no code with either way.
double streamed(const std::string& number) {
  std::istringstream stream(number);
  stream.imbue(std::locale::classic());
  double value = std::numeric_limits<double>::quiet_NaN();
  stream >> value;
  return value;
}

std::uint64_t bits(double value) {
  std::uint64_t result = 0;
  std::memcpy(&result, &value, sizeof(result));
  return result;
}

std::size_t digitCount(const std::string& number) {
  std::size_t count = 0;
  bool leading = true;
  std::size_t trailing_zeros = 0;
  for (const char c : number.substr(0, number.find_first_of("eE"))) {
    if (c < '0' || c > '9') continue;
    leading = leading && c == '0';
    if (leading) continue;
    ++count;
    trailing_zeros = c == '0' ? trailing_zeros + 1 : 0;
  }
  return count - trailing_zeros;
}

std::vector<double> randomDoubles(int count) {
  std::mt19937_64 generator(20100521);
  std::vector<double> values;
  while (static_cast<int>(values.size()) < count) {
    const std::uint64_t pattern = generator();
    double value = 0;
    std::memcpy(&value, &pattern, sizeof(value));
    if (std::isfinite(value)) values.push_back(value);
  }
  return values;
}

// Puts the process into a locale with a decimal comma, made for the purpose when none is installed.
bool enterCommaLocale() {
  if (std::setlocale(LC_NUMERIC, "de_DE.UTF-8") != nullptr) return true;
  const std::string folder = testing::TempDir() + "number_text_locale";
  const std::string make = "mkdir -p '" + folder + "' && localedef -i de_DE -f UTF-8 '" + folder +
                           "/de_DE.UTF-8' >/dev/null 2>&1";
  if (std::system(make.c_str()) != 0) return false;
  setenv("LOCPATH", folder.c_str(), 1);
  const bool entered = std::setlocale(LC_NUMERIC, "de_DE.UTF-8") != nullptr;
  unsetenv("LOCPATH");
  return std::system(("rm -r '" + folder + "'").c_str()) == 0 && entered;
}

TEST_P(NumberText, WritesTheDigitsAPersonWouldWrite) {
  EXPECT_EQ(text(0.1), "0.1");
  EXPECT_EQ(text(-9.81), "-9.81");
  EXPECT_EQ(text(0), "0");
  EXPECT_EQ(text(2), "2");
  EXPECT_EQ(text(0.30000000000000004), "0.30000000000000004");
  EXPECT_EQ(text(1e300), "1e+300");
  EXPECT_EQ(digitCount(text(kSmallest)), 1u);
  EXPECT_EQ(digitCount(text(1.5e-310)), 2u);
}

TEST_P(NumberText, WrittenNumbersReadBackAsTheSameBits) {
  std::vector<double> values = randomDoubles(20000);
  for (const double value : {0.0, -0.0, kLargest, -kLargest, kSmallestNormal, kSmallest, -kSmallest,
                             9007199254740993.0, 5.684341886080801e-14, 1.0 / 3, 123456789.125}) {
    values.push_back(value);
  }
  for (const double value : values) {
    const std::string written = text(value);
    EXPECT_EQ(bits(parsed(written)), bits(value)) << written;
    if (std::abs(value) >= kSmallestNormal) {  // streams call subnormal numbers an error
      EXPECT_EQ(bits(streamed(written)), bits(value)) << written;
    }
  }
}

TEST_P(NumberText, WritesNoMoreDigitsThanNeeded) {
  std::mt19937_64 generator(7);
  std::uniform_int_distribution<std::int64_t> mantissa(100000, 999999);
  std::uniform_int_distribution<int> exponent(-30, 30);
  for (int i = 0; i < 5000; ++i) {
    const std::string short_number =
        std::to_string(mantissa(generator)) + "e" + std::to_string(exponent(generator));
    EXPECT_LE(digitCount(text(streamed(short_number))), 6u) << short_number;
  }
  // Sign, point, 17 digits and a three-digit exponent.
  for (const double value : randomDoubles(5000)) EXPECT_LE(text(value).size(), 24u);
}

TEST_P(NumberText, AppendsBehindWhatIsThere) {
  std::string line = "time,";
  GetParam().append(line, 0.5);
  EXPECT_EQ(line, "time,0.5");
}

TEST_P(NumberText, ReadsEveryDecimalForm) {
  EXPECT_EQ(parsed("1"), 1.0);
  EXPECT_EQ(parsed("+1.5"), 1.5);
  EXPECT_EQ(parsed("-.5"), -0.5);
  EXPECT_EQ(parsed("5."), 5.0);
  EXPECT_EQ(parsed("1e3"), 1000.0);
  EXPECT_EQ(parsed("1E+03"), 1000.0);
  EXPECT_EQ(parsed("-2.5e-1"), -0.25);
  EXPECT_EQ(parsed("  7\t"), 7.0);
  EXPECT_EQ(parsed("000.125"), 0.125);
  EXPECT_EQ(parsed("-0.28474055422314815"), -0.28474055422314815);
  EXPECT_TRUE(std::signbit(parsed("-0")));
}

TEST_P(NumberText, ReadsUnderflowAsTheNearestSmallNumber) {
  EXPECT_EQ(parsed("1e-400"), 0.0);
  EXPECT_EQ(parsed("-1e-400"), 0.0);
  EXPECT_EQ(parsed("5e-324"), kSmallest);
  EXPECT_EQ(parsed("2.5e-310"), 2.5e-310);
}

TEST_P(NumberText, RefusesWhatIsNoFiniteNumber) {
  for (const char* number : {"",
                             " ",
                             "+",
                             "-",
                             ".",
                             "abc",
                             "nan",
                             "NaN",
                             "-nan",
                             "inf",
                             "-inf",
                             "+Infinity",
                             "0x10",
                             "0x1p3",
                             "-0X1",
                             "1,5",
                             "1.5.2",
                             "1 2",
                             "1e",
                             "1e+",
                             "e5",
                             "+-1",
                             "--1",
                             "++1",
                             "1m",
                             "1_000",
                             "1e309",
                             "-1e309",
                             "1e99999999999",
                             "1e309x",
                             "1e-400x",
                             "- 1",
                             "1\n"}) {
    EXPECT_FALSE(parses(number)) << "'" << number << "'";
  }
  EXPECT_FALSE(parses(std::string("1\0", 2)));
}

TEST_P(NumberText, LeavesTheValueAloneWhenItRefuses) {
  double value = 42;
  EXPECT_FALSE(GetParam().parse("1e999", value));
  EXPECT_FALSE(GetParam().parse("1x", value));
  EXPECT_EQ(value, 42);
}

TEST_P(NumberText, DoesNotDependOnTheLocale) {
  if (!enterCommaLocale()) GTEST_SKIP() << "no locale with a decimal comma can be had here";
  ASSERT_EQ(std::string(std::localeconv()->decimal_point), ",");
  const std::string written = text(0.5);
  const bool point = parses("0.5");
  const bool comma = parses("0,5");
  std::setlocale(LC_NUMERIC, "C");
  EXPECT_EQ(written, "0.5");
  EXPECT_TRUE(point);
  EXPECT_FALSE(comma);
}

INSTANTIATE_TEST_SUITE_P(Ways, NumberText,
                         testing::Values(Way{"Library", appendNumber, parseNumber},
                                         Way{"Portable", portable::appendNumber,
                                             portable::parseNumber}),
                         [](const auto& way) { return way.param.name; });

// Messages and files are the same whatever standard library wrote them.
TEST(PortableNumberText, IsThatOfCharconv) {
  const auto expectSame = [](double value) {
    std::string text, portable_text;
    appendNumber(text, value);
    portable::appendNumber(portable_text, value);
    EXPECT_EQ(portable_text, text);
  };
  for (int exponent = -30; exponent <= 30; ++exponent) {
    for (int k = 1; k < 30; ++k) {
      expectSame(k * std::pow(10.0, exponent));
      expectSame(-k / 7.0 * std::pow(10.0, exponent));
    }
  }
  for (const double value : {0.0, -0.0, 1e5, 0x1p60, 1e22, 1e23, 5e-324, 1.7976931348623157e308}) {
    expectSame(value);
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
