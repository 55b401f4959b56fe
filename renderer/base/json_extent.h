// How deep and large a JSON text is, found without parsing it: parsers and writers of JSON recurse, and deep nesting
// overflows their stacks.
#pragma once

#include <cstdint>
#include <string_view>

namespace irad {

constexpr uint64_t kMaxJsonDepth = 128;  ///< deeper texts are refused by all readers

struct JsonExtent {
  uint64_t depth = 0;     ///< brackets and braces inside one another
  uint64_t elements = 0;  ///< members, elements and containers, at most
};
/// Takes any text; brackets inside strings do not count.
JsonExtent jsonExtent(std::string_view text);

}  // namespace irad
