#include "renderer/base/temporary_folder.h"

#include <stdlib.h>

#include <cerrno>
#include <cstring>

#include "renderer/base/error.h"

namespace irad {

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "irad-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr)
    throw WorkError(fmt::format("{}: cannot be made: {}", pattern, std::strerror(errno)));
  path = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path, ignored);
}

}  // namespace irad
