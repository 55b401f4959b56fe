// Rows of settings, generated from their table.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "gi/settings.h"

namespace irad {

struct Session;

/// "voxel", "field", ...: what stands before the dot of settings' names, in their order.
std::vector<std::string> settingGroups();
/// One row per setting under the headers of their groups: label, widget by the member's type, unit, help as tooltip,
/// and a reset button where it differs from `defaults`. Clicks on headers add to `folded` ("Settings/voxel") or take
/// away from it.
void settingRows(Settings& settings, const Settings& defaults, std::set<std::string>& folded);
/// The row of the setting of that name.
void settingRow(Settings& settings, const Settings& defaults, std::string_view name);
/// An arrow that opens the list of the values of the setting of that name, which must be an enumeration's.
void settingArrow(Settings& settings, std::string_view name);

/// A button that asks for a name (kept in `name`) and saves these settings as a preset under it.
void savePresetButton(const char* label, float width, std::string& name, Session& session, const Settings& settings);

}  // namespace irad
