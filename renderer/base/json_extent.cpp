#include "renderer/base/json_extent.h"

#include <algorithm>

namespace irad {

JsonExtent jsonExtent(std::string_view text) {
  JsonExtent extent;
  uint64_t depth = 0;
  bool inString = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') inString = !inString;
    if (inString) {
      i += c == '\\';  // what follows is part of the string, a quote too
      continue;
    }
    if (c == '{' || c == '[') extent.depth = std::max(extent.depth, ++depth);
    if ((c == '}' || c == ']') && depth > 0) --depth;
    extent.elements += c == ',' || c == ':' || c == '{' || c == '[';
  }
  return extent;
}

std::string jsonProblem(const std::exception& error) {
  const std::string text = error.what();  // "[json.exception.parse_error.101] parse error ..."
  const size_t end = text.find("] ");
  return text.starts_with("[json.") && end != text.npos ? text.substr(end + 2) : text;
}

}  // namespace irad
