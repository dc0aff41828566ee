#include "base/number_text.h"

#include <locale.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "base/number_text_portable.h"

#if defined(__cpp_lib_to_chars) && __cpp_lib_to_chars >= 201611L
#define VWD_HAS_FLOAT_CHARCONV 1
#else
#define VWD_HAS_FLOAT_CHARCONV 0
#endif

namespace virtual_work_dynamics {
namespace {

// Puts the calling thread into the C locale: the C library prints and reads the decimal point of
// the process's locale, which a program around this library may have set to a comma.
class ClassicLocaleScope {
 public:
  ClassicLocaleScope() : previous_(uselocale(classic())) {}
  ~ClassicLocaleScope() { uselocale(previous_); }
  ClassicLocaleScope(const ClassicLocaleScope&) = delete;
  ClassicLocaleScope& operator=(const ClassicLocaleScope&) = delete;

 private:
  static locale_t classic() {
    static const locale_t locale = newlocale(LC_ALL_MASK, "C", nullptr);
    return locale;
  }

  locale_t previous_;
};

bool isBlank(char c) {
  return c == ' ' || c == '\t';
}

// Narrows [begin, end) to the number without blanks and leading '+'. Returns false when the rest
// does not start like a decimal number, as "inf", "nan" and "+-1" do not.
bool trimToNumber(const char*& begin, const char*& end) {
  while (begin != end && isBlank(*begin)) ++begin;
  while (begin != end && isBlank(end[-1])) --end;
  const bool plus = begin != end && *begin == '+';
  if (plus) ++begin;
  const char* first = begin;
  if (!plus && first != end && *first == '-') ++first;
  return first != end && ((*first >= '0' && *first <= '9') || *first == '.');
}

}  // namespace

namespace portable {

void appendNumber(std::string& text, double value) {
  assert(std::isfinite(value));
  const ClassicLocaleScope classic;
  // A decimal of up to 15 digits survives the way through a normal double, so that fewer digits
  // need not be tried.
  const bool subnormal = std::abs(value) < std::numeric_limits<double>::min();
  char buffer[32];
  int digits = subnormal ? 1 : 15;
  const auto print = [&] {
    std::snprintf(buffer, sizeof(buffer), "%.*e", digits - 1, value);
    return std::strtod(buffer, nullptr) == value;
  };
  while (!print() && digits < 17) ++digits;
  // As to_chars() does: the shorter of both notations, the fixed one where they are equally long.
  std::string scientific = buffer;
  const std::size_t exponent_at = scientific.find('e');
  std::size_t end = exponent_at;
  while (scientific[end - 1] == '0' && scientific.find('.') < end) --end;
  if (scientific[end - 1] == '.') --end;
  scientific.erase(end, exponent_at - end);
  const int exponent = std::atoi(buffer + exponent_at + 1);
  const int significant =
      static_cast<int>(std::count_if(scientific.begin(), scientific.begin() + static_cast<int>(end),
                                     [](char c) { return c >= '0' && c <= '9'; }));
  char fixed[400];
  const int length =
      std::snprintf(fixed, sizeof(fixed), "%.*f", std::max(0, significant - 1 - exponent), value);
  text += static_cast<std::size_t>(length) <= scientific.size() ? fixed : scientific.c_str();
}

bool parseNumber(const std::string& text, double& value) {
  const char* begin = text.data();
  const char* end = begin + text.size();
  if (!trimToNumber(begin, end)) return false;
  const std::string number(begin, end);
  if (number.find_first_of("xX") != std::string::npos) return false;  // strtod reads hexadecimal
  const ClassicLocaleScope classic;
  char* stop = nullptr;
  const double result = std::strtod(number.c_str(), &stop);
  if (stop != number.c_str() + number.size() || !std::isfinite(result)) return false;
  value = result;
  return true;
}

}  // namespace portable

#if VWD_HAS_FLOAT_CHARCONV

void appendNumber(std::string& text, double value) {
  assert(std::isfinite(value));
  char buffer[32];
  const std::to_chars_result result = std::to_chars(buffer, buffer + sizeof(buffer), value);
  text.append(buffer, result.ptr);
}

bool parseNumber(const std::string& text, double& value) {
  const char* begin = text.data();
  const char* end = begin + text.size();
  if (!trimToNumber(begin, end)) return false;
  double result = 0;
  const std::from_chars_result read = std::from_chars(begin, end, result);
  // from_chars does not tell overflow from underflow.
  if (read.ec == std::errc::result_out_of_range) return portable::parseNumber(text, value);
  if (read.ec != std::errc() || read.ptr != end) return false;
  value = result;
  return true;
}

#else

void appendNumber(std::string& text, double value) {
  portable::appendNumber(text, value);
}

bool parseNumber(const std::string& text, double& value) {
  return portable::parseNumber(text, value);
}

#endif

std::string numberText(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  std::string text;
  appendNumber(text, value);
  return text;
}

void appendSeconds(std::string& text, std::int64_t ns) {
  constexpr std::int64_t kSecond = 1000000000;
  const std::int64_t seconds = ns / kSecond;
  if (ns < 0 && seconds == 0) text += '-';
  // The leading one keeps the zeros of the nanoseconds.
  text +=
      std::to_string(seconds) + '.' + std::to_string(kSecond + std::abs(ns % kSecond)).substr(1);
}

bool isNotANumber(std::string_view text) {
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) text.remove_prefix(1);
  return text == "nan" || text == "inf" || text == "NaN" || text == "Infinity";
}

}  // namespace virtual_work_dynamics
