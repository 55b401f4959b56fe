// Comma-separated values as RFC 4180 writes them.
#pragma once

#include <string>

namespace irad {

/// `text` as one field: in quotation marks, those within doubled, where it holds a comma, a quotation mark or an end of
/// line.
inline std::string csvField(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + '"';
}

}  // namespace irad
