#include "base/json_text.h"

#include <cstdio>

namespace virtual_work_dynamics {

std::string jsonText(const std::string& text) {
  std::string json = "\"";
  for (const char letter : text) {
    if (letter == '"' || letter == '\\') {
      json += '\\';
      json += letter;
    } else if (static_cast<unsigned char>(letter) < 0x20) {
      char code[8];
      std::snprintf(code, sizeof code, "\\u%04x", static_cast<unsigned char>(letter));
      json += code;
    } else {
      json += letter;
    }
  }
  return json + "\"";
}

}  // namespace virtual_work_dynamics
