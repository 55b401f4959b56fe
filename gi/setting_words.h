// Settings and their groups in words, for people: beside their table (gi/settings_table.cpp), so that a new setting is
// one member and the rows there.
#pragma once

#include <string>
#include <string_view>

namespace irad {

/// Of "solver.sweeps_per_frame": "sweeps per frame". Words stand in place of letters and of what says nothing by
/// itself.
std::string settingLabel(std::string_view name);
/// What the settings "voxel.*" are about; empty: there is no such group.
std::string_view settingGroupHelp(std::string_view group);

}  // namespace irad
