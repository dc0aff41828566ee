#include "base/nearest_name.h"

#include <algorithm>

#include "base/printable.h"

namespace virtual_work_dynamics {
namespace {

constexpr std::size_t kLongest = 200;          // bytes of names that are compared
constexpr std::size_t kShortestPart = 3;       // bytes of a name that is looked for in others
constexpr std::size_t kMostCompared = 100000;  // names, so that a message never takes long

std::string lowered(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

bool differsInNumbersOnly(std::string a, std::string b) {
  a.erase(std::remove_if(a.begin(), a.end(), isDigit), a.end());
  b.erase(std::remove_if(b.begin(), b.end(), isDigit), b.end());
  return a == b;
}

// The only known name that contains `name`; empty when none or several do.
std::string onlyWith(const std::string& name, const std::vector<std::string>& known) {
  const auto contains = [&](const std::string& other) {
    return other.find(name) != std::string::npos;
  };
  if (name.size() < kShortestPart) return "";
  const auto found = std::find_if(known.begin(), known.end(), contains);
  if (found == known.end() || std::any_of(found + 1, known.end(), contains)) return "";
  return *found;
}

}  // namespace

std::size_t editDistance(std::string_view a, std::string_view b, std::size_t most) {
  if (a.size() > b.size()) std::swap(a, b);
  if (b.size() - a.size() > most) return most + 1;
  std::vector<std::size_t> before, last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t exchanged = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, exchanged});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    if (*std::min_element(row.begin(), row.end()) > most) return most + 1;
    before = last;
    std::swap(last, row);
  }
  return std::min(last[b.size()], most + 1);
}

std::string nearestName(const std::string& name, const std::vector<std::string>& known) {
  if (name.empty() || name.size() > kLongest || known.size() > kMostCompared) return "";
  const std::string wanted = lowered(name);
  std::size_t least = wanted.size() / 3 + 1;
  const std::string* nearest = nullptr;
  for (const std::string& candidate : known) {
    const std::string other = lowered(candidate);
    const std::size_t distance = editDistance(wanted, other, least - 1);
    if (distance >= least || (distance > 0 && differsInNumbersOnly(wanted, other))) continue;
    least = distance;
    nearest = &candidate;
    if (least == 0) break;
  }
  return nearest ? *nearest : onlyWith(name, known);
}

std::string nameHelp(const std::string& name, const std::vector<std::string>& known) {
  const std::string nearest = nearestName(name, known);
  if (!nearest.empty()) return "; did you mean " + inQuotes(nearest) + "?";
  return known.empty() ? "" : "; known are " + namesInQuotes(known);
}

}  // namespace virtual_work_dynamics
