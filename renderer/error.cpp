#include "renderer/error.h"

#include <cstdio>
#include <cstdlib>

namespace irad {

void invariantFailed(const char* file, int line, const std::string& message) {
  fmt::print(stderr, "irad: broken invariant at {}:{}: {}\n", file, line, message);
  std::fflush(stderr);
  std::abort();
}

}  // namespace irad
