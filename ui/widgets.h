// Small pieces that panels share: setting rows generated from visit(), value tables, help tooltips.
#pragma once

#include <string>
#include <string_view>
#include <vector>

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

/// A label in the dim colour and a value at the column where values begin; a value too long is cut with an ellipsis and
/// shown whole as a tooltip.
void valueRow(const char* label, const std::string& value);

/// The label of a row, in the same place; the next widget takes the rest of it.
void fieldLabel(const char* label, const std::string& help = {});

void helpTooltip(const std::string& text);
/// Text that ends in an ellipsis where the width does not suffice.
void clippedText(const std::string& text, float width);
/// Right-aligned in the current table cell or region.
void rightText(const std::string& text);

/// A table in the rest of the region whose columns hold numbers, but for those whose indices are in `words`, which
/// share what the numbers leave. True: end it with ImGui::EndTable().
bool beginNumberTable(const char* id, const std::vector<const char*>& columns, const std::vector<size_t>& words);

/// When to derive anew what is costly: four times a second while frames follow each other, and in the last of them.
class Refresh {
 public:
  bool due(const Session& session);

 private:
  double last_ = -1;
};

/// A unit as registries spell it, for the eye: "W/m^2" becomes "W/m²".
std::string prettyUnit(std::string_view unit);
std::string milliseconds(double value);  ///< "0.12", "12.3", "1234"
std::string mebibytes(uint64_t bytes);
/// 3 significant digits, exponent where needed: "0.0123", "1.2e-06".
std::string shortNumber(double value);
std::string withThousands(uint64_t value);

}  // namespace irad
