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
/// Which settings are shown.
struct SettingFilter {
  std::string words;         ///< between spaces: all must be in a setting's name or help, in either case
  bool changedOnly = false;  ///< those that are not their defaults
  bool on() const { return changedOnly || words.find_first_not_of(' ') != std::string::npos; }
  bool passes(const Setting& setting, const Settings& settings, const Settings& defaults) const;
};
/// One row per setting under the headers of their groups: label, widget by the member's type, unit, help with range and
/// default as tooltip, and a reset button where it differs from `defaults`; one for its group beside the header. Clicks
/// on headers add to `folded` ("Settings/voxel") or take away from it; what a filter finds is shown in folded groups
/// too. Settings that rebuild and are not as `built` are marked: they wait. False: the filter has found none.
bool settingRows(Settings& settings, const Settings& defaults, std::set<std::string>& folded,
                 const SettingFilter& filter = {}, const Settings* built = nullptr);
/// A table of the settings in which two differ, with the values of both under these titles; false: they differ in none,
/// and nothing is drawn. Which facet is picked is no difference.
bool differenceTable(const char* id, const Settings& a, const Settings& b, const char* titleA, const char* titleB);
/// In a comparison: which side a panel edits, and shows.
void sideLine(const Session& session);
/// The row of the setting of that name.
void settingRow(Settings& settings, const Settings& defaults, std::string_view name);
/// An arrow that opens the list of the values of the setting of that name, which must be an enumeration's.
void settingArrow(Settings& settings, std::string_view name);

/// A button that asks for a name (kept in `name`) and saves these settings as a preset under it.
void savePresetButton(const char* label, float width, std::string& name, Session& session, const Settings& settings);

}  // namespace irad
