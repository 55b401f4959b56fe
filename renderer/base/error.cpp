#include "renderer/base/error.h"

#include <cstdlib>

#include "renderer/base/console.h"

namespace irad {

void invariantFailed(const char* file, int line, const std::string& message) {
  tell("irad: broken invariant at {}:{}: {}\n", file, line, message);
  std::abort();
}

}  // namespace irad
