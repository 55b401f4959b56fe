// Pictures out of the window.
#pragma once

#include <filesystem>

#include "ui/session.h"

namespace irad {

/// The view as shown (PNG), and its light before exposure (EXR), under the first free number in `folder`; says where,
/// or what went wrong.
void captureView(Context& context, Session& session, const std::filesystem::path& folder);

/// An RGBA8 image as PNG; throws WorkError.
void saveScreenshot(Context& context, const Image& image, const std::filesystem::path& file);

}  // namespace irad
