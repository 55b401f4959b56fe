#include "ui/open_folder.h"

#include <fmt/format.h>

#include "gi/check/process.h"
#include "renderer/base/error.h"

namespace irad {

void openFolder(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored))
    throw WorkError(fmt::format("{} is not there any more", folder.string()));
  const std::filesystem::path program = findProgram("xdg-open");
  if (program.empty())
    throw WorkError(
        fmt::format("{} cannot be opened from here: xdg-open is not installed (package xdg-utils)", folder.string()));
  // A shell that ends at once: a Process is killed with its object, and some file managers run in xdg-open's place.
  Process("/bin/sh", {"-c", R"("$0" "$1" &)", program.string(), folder.string()}).wait();
}

}  // namespace irad
