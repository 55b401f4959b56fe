// One dark theme: colours, sizes and fonts. Colours are sRGB-encoded, as the window image is.
#pragma once

#include <cstdint>

struct ImFontAtlas;
struct ImGuiStyle;
struct ImVec4;

namespace irad {

void applyTheme(ImGuiStyle& style, float scale);
/// Body font first, then headings. Inter (package fonts-inter), else DejaVu Sans, else ImGui's built-in.
void addFonts(ImFontAtlas& fonts, float scale);

/// Whether they are asked for this code point: any other is shown as a question mark.
bool fontsHold(uint32_t codePoint);

/// Pushes the heading font; pop with ImGui::PopFont().
void pushHeadingFont();

/// "→" and "↺", or what stands for them where the font has no such glyph.
const char* arrowGlyph();
const char* resetGlyph();

namespace theme {
extern const ImVec4 text, dim, accent, warning, error, alarm, good, plotFill, plotLine;
}

}  // namespace irad
