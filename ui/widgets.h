// Small pieces that panels share: rows of a label and a value, tables, help tooltips.
#pragma once

#include <concepts>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/base/number_text.h"

namespace irad {

struct Session;

/// Share of a row that its label takes.
constexpr float kLabelShare = 0.42f;

/// A label in the dim colour and a value at the column where values begin; a value too long is cut with an ellipsis and
/// shown whole as a tooltip. What it is, and its unit, is said by the helpTooltip() that follows. For tests it is
/// "label=value".
void valueRow(const char* label, const std::string& value);

/// The label of a row, in the same place; the next widget takes the rest of it. The help is the whole row's.
void fieldLabel(const char* label, std::string_view help);

/// Keeps in `folded` the titles of what is not open.
void keepFolded(std::set<std::string>& folded, const std::string& title, bool open);

/// Closes the list, or the menu with those that it opened (the mouse over one would open it again), over so many
/// dialogs that stay; false: there is none.
bool closePopup(int dialogs);

/// Of the last item, also where it is disabled: what it is or does.
void helpTooltip(std::string_view text);
/// The tooltip of the last item is to be shown now, or a test wants all of them.
bool wantsHelp();
/// Texts that take time are made only where they are shown.
template <std::invocable Text>
void helpTooltip(Text&& text) {
  if (wantsHelp()) helpTooltip(std::string(text()));
}
/// Text that ends in an ellipsis where the width does not suffice.
std::string clipped(const std::string& text, float width);
/// The same, and whole as a tooltip.
void clippedText(const std::string& text, float width);
/// Right-aligned in the current table cell or region.
void rightText(const std::string& text);

struct TableColumn {
  const char* title;
  const char* help;    ///< what it holds, with its unit: a tooltip on the title
  bool words = false;  ///< no number
};
/// A table in the rest of the region, whose columns of words share what those of numbers leave. True: end it with
/// ImGui::EndTable().
bool beginNumberTable(const char* id, const std::vector<TableColumn>& columns);

/// When to recompute what is costly: while frames follow each other four times a second, in every eighth of them at
/// most; and when they come to rest.
class Refresh {
 public:
  bool due(const Session& session);

 private:
  double last_ = -1;
  bool rested_ = false;
  uint32_t frames_ = 0;  ///< since then
};

}  // namespace irad
