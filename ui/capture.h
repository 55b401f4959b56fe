// Pictures out of the window.
#pragma once

#include <filesystem>

#include "gi/manifest.h"
#include "ui/session.h"

namespace irad {

/// What made the picture that `pipeline` shows: settings, scene with all edits, device, view, camera, now.
Manifest manifestOf(const Session& session, const Pipeline& pipeline, std::string subcommand, const Program& program);

/// Makes a new folder `parent`/SCENE.NNN of the view shown, or of all: VIEW.png as shown, VIEW.exr linear, at the
/// viewport's size, and the manifest.json from which `irad render --config` makes the same bits. The pictures are drawn
/// from light that is solved as it does (Pipeline::solvedAfresh). In a comparison the folders a and b in it hold all
/// that of either side. Reports where they are, or what went wrong; then there is no folder.
void saveCapture(Session& session, bool allViews, const std::filesystem::path& parent, const Program& program,
                 const Progress& progress);

/// An RGBA8 image as PNG; throws WorkError.
void saveScreenshot(Context& context, const Image& image, const std::filesystem::path& file);

}  // namespace irad
