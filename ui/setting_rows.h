// Rows of settings, generated from visit().
#pragma once

#include <string>
#include <string_view>

#include "gi/settings.h"

namespace irad {

struct Session;

/// One row per setting whose name `wanted` accepts (a prefix such as "camera."; empty: all, under group headers):
/// label, widget by the member's type, unit, help as tooltip, and a reset button where it differs from `defaults`. True
/// when something was edited.
bool settingRows(Settings& settings, const Settings& defaults, std::string_view prefix = {});
/// The one setting of that name.
bool settingRow(Settings& settings, const Settings& defaults, std::string_view name);

/// A button that asks for a name (kept in `name`) and saves these settings as a preset under it.
void savePresetButton(const char* label, float width, std::string& name, Session& session, const Settings& settings);

}  // namespace irad
