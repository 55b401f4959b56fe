// How deep and large a JSON text is, found without parsing it: parsers and writers of JSON recurse, and deep nesting
// overflows their stacks. And what is wrong with one, in words.
#pragma once

#include <cstdint>
#include <exception>
#include <string>
#include <string_view>

namespace irad {

constexpr uint64_t kMaxJsonDepth = 128;  ///< deeper texts are refused by all readers

struct JsonExtent {
  uint64_t depth = 0;     ///< brackets and braces inside one another
  uint64_t elements = 0;  ///< members, elements and containers, at most
};
/// Takes any text; brackets inside strings do not count.
JsonExtent jsonExtent(std::string_view text);

/// What a parser of JSON says, without the library's own name of it: "parse error at line 1, column 1: ...".
std::string jsonProblem(const std::exception& error);

}  // namespace irad
