#include "generate/c_names.h"

#include <set>

#include "base/number_text.h"
#include "base/printable.h"

namespace virtual_work_dynamics {

namespace {

// Not those of <cctype>, which ask the locale.
bool isDigit(char c) {
  return c >= '0' && c <= '9';
}
bool isLetter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

// Letters and digits of a name, with single underscores for what is between them: two of them in a
// row belong to the compilers.
std::string words(const std::string& name) {
  std::string text;
  bool gap = false;
  for (const char c : name) {
    const bool legal = isLetter(c) || isDigit(c);
    if (legal && gap && !text.empty()) text += '_';
    gap = !legal;
    if (legal) text += c;
  }
  return text;
}

void replaceAll(std::string& text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at)) {
    text.replace(at, what.size(), by);
    at += by.size() - 1;
  }
}

}  // namespace

std::string identifierOf(const std::string& name) {
  std::string identifier = words(name);
  if (identifier.empty() || !isLetter(identifier[0])) identifier.insert(0, "robot_");
  return identifier;
}

std::string inCapitals(std::string text) {
  for (char& c : text) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return text;
}

std::vector<std::string> constantNames(const std::string& prefix,
                                       const std::vector<std::string>& names) {
  std::vector<std::string> constants;
  std::set<std::string> taken;
  for (const std::string& name : names) {
    const std::string legal = words(name);
    std::string constant = prefix + "_" + (legal.empty() ? "NAMELESS" : inCapitals(legal));
    const std::string first = constant;
    for (int i = 2; !taken.insert(constant).second; ++i) constant = first + "_" + std::to_string(i);
    constants.push_back(constant);
  }
  return constants;
}

std::string cString(const std::string& text) {
  std::string literal = "\"";
  for (const char c : text) {
    const unsigned char byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\' || c == '?') {  // ?: no trigraphs
      literal += '\\';
      literal += c;
    } else if (byte < 0x20 || byte >= 0x7f) {
      literal += '\\';
      for (const int shift : {6, 3, 0}) literal += static_cast<char>('0' + (byte >> shift & 7));
    } else {
      literal += c;
    }
  }
  return literal + "\"";
}

std::string inComment(const std::string& text) {
  std::string line = printable(text);
  replaceAll(line, "*/", "* /");
  replaceAll(line, "/*", "/ *");
  replaceAll(line, "??", "? ?");
  return line;
}

std::string cNumber(double value) {
  std::string text;
  appendNumber(text, value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

}  // namespace virtual_work_dynamics
