// A folder in the desktop's file manager.
#pragma once

#include <filesystem>

namespace irad {

/// By xdg-open; the file manager outlives the window. WorkError where the folder has gone, or xdg-open is not
/// installed.
void openFolder(const std::filesystem::path& folder);

}  // namespace irad
