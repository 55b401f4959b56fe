#include "ui/theme.h"

#include <array>
#include <cmath>
#include <filesystem>

#include "renderer/base/image_io.h"
#include "ui/imgui.h"

namespace irad {
namespace theme {
const ImVec4 text{0.86f, 0.87f, 0.89f, 1}, dim{0.58f, 0.61f, 0.65f, 1}, accent{0.93f, 0.66f, 0.26f, 1},
    warning{0.95f, 0.77f, 0.36f, 1}, error{0.96f, 0.47f, 0.42f, 1}, alarm{0.62f, 0.09f, 0.08f, 1},
    good{0.52f, 0.80f, 0.58f, 1}, plotFill{0.93f, 0.66f, 0.26f, 0.22f}, plotLine{0.93f, 0.66f, 0.26f, 1};
}

namespace {

constexpr float kBodyPixels = 14.0f, kHeadingPixels = 15.0f;

/// Code points that labels, units and values use.
constexpr ImWchar kGlyphs[] = {0x0020, 0x00FF,  // Latin-1: superscripts, degree, multiplication sign
                               0x0370, 0x03FF,  // Greek: rho, lambda, delta
                               0x2010, 0x2026,  // dashes, quotation marks, ellipsis
                               0x2190, 0x2199,  // arrows
                               0x21BA, 0x21BA,  // reset
                               0x2212, 0x2212,  // minus
                               0x221A, 0x221A,  // root
                               0x2260, 0x2265,  // comparisons
                               0};

/// As kTextFonts, for headings.
constexpr std::array kHeadingFiles{"/usr/share/fonts/opentype/inter/Inter-SemiBold.otf",
                                   "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf"};

template <size_t N>
void addFont(ImFontAtlas& fonts, const std::array<const char*, N>& files, float pixels) {
  ImFontConfig config;
  config.OversampleH = 2;
  config.OversampleV = 1;
  for (const char* file : files)
    if (std::filesystem::exists(file) && fonts.AddFontFromFileTTF(file, pixels, &config, kGlyphs)) return;
  config.SizePixels = std::floor(pixels * 13.0f / 14.0f);
  fonts.AddFontDefault(&config);
}

bool hasGlyph(ImWchar code) {
  return ImGui::GetFont()->FindGlyphNoFallback(code) != nullptr;
}

}  // namespace

void addFonts(ImFontAtlas& fonts, float scale) {
  addFont(fonts, kTextFonts, std::round(kBodyPixels * scale));
  addFont(fonts, kHeadingFiles, std::round(kHeadingPixels * scale));
}

void pushHeadingFont() {
  const ImVector<ImFont*>& fonts = ImGui::GetIO().Fonts->Fonts;
  ImGui::PushFont(fonts[fonts.Size > 1 ? 1 : 0]);
}

bool fontsHold(uint32_t codePoint) {
  for (const ImWchar* range = kGlyphs; *range != 0; range += 2)
    if (codePoint >= range[0] && codePoint <= range[1]) return true;
  return false;
}

const char* arrowGlyph() {
  return hasGlyph(0x2192) ? "\u2192" : "->";
}
const char* resetGlyph() {
  return hasGlyph(0x21BA) ? "\u21BA" : "x";
}

void applyTheme(ImGuiStyle& style, float scale) {
  style = ImGuiStyle();
  style.WindowPadding = {10, 8};
  style.FramePadding = {7, 3};
  style.ItemSpacing = {7, 5};
  style.ItemInnerSpacing = {6, 4};
  style.CellPadding = {5, 2};
  style.IndentSpacing = 14;
  style.ScrollbarSize = 11;
  style.GrabMinSize = 9;
  style.WindowRounding = 0;
  style.ChildRounding = 3;
  style.FrameRounding = 3;
  style.PopupRounding = 4;
  style.GrabRounding = 3;
  style.ScrollbarRounding = 6;
  style.WindowBorderSize = 1;
  style.FrameBorderSize = 0;
  style.WindowTitleAlign = {0, 0.5f};
  style.WindowMenuButtonPosition = ImGuiDir_None;
  style.ScaleAllSizes(scale);

  const ImVec4 ground{0.098f, 0.102f, 0.110f, 1}, raised{0.145f, 0.150f, 0.161f, 1}, field{0.192f, 0.199f, 0.213f, 1},
      hover{0.247f, 0.257f, 0.275f, 1}, line{0.227f, 0.235f, 0.251f, 1};
  const auto faded = [](ImVec4 color, float alpha) { return ImVec4(color.x, color.y, color.z, alpha); };
  ImVec4* color = style.Colors;
  for (int i = 0; i < ImGuiCol_COUNT; ++i) color[i] = field;
  color[ImGuiCol_Text] = theme::text;
  color[ImGuiCol_TextDisabled] = theme::dim;
  color[ImGuiCol_WindowBg] = ground;
  color[ImGuiCol_ChildBg] = faded(ground, 0);
  color[ImGuiCol_PopupBg] = faded(raised, 0.98f);
  color[ImGuiCol_Border] = line;
  color[ImGuiCol_BorderShadow] = faded(ground, 0);
  color[ImGuiCol_FrameBg] = field;
  color[ImGuiCol_FrameBgHovered] = hover;
  color[ImGuiCol_FrameBgActive] = hover;
  color[ImGuiCol_TitleBg] = raised;
  color[ImGuiCol_TitleBgActive] = raised;
  color[ImGuiCol_TitleBgCollapsed] = raised;
  color[ImGuiCol_MenuBarBg] = raised;
  color[ImGuiCol_ScrollbarBg] = faded(ground, 0);
  color[ImGuiCol_ScrollbarGrab] = hover;
  color[ImGuiCol_ScrollbarGrabHovered] = faded(theme::dim, 0.6f);
  color[ImGuiCol_ScrollbarGrabActive] = theme::dim;
  color[ImGuiCol_CheckMark] = theme::accent;
  color[ImGuiCol_SliderGrab] = faded(theme::accent, 0.45f);  // the value is written over it
  color[ImGuiCol_SliderGrabActive] = faded(theme::accent, 0.7f);
  color[ImGuiCol_Button] = field;
  color[ImGuiCol_ButtonHovered] = hover;
  color[ImGuiCol_ButtonActive] = faded(theme::accent, 0.55f);
  color[ImGuiCol_Header] = raised;
  color[ImGuiCol_HeaderHovered] = hover;
  color[ImGuiCol_HeaderActive] = hover;
  color[ImGuiCol_Tab] = raised;
  color[ImGuiCol_TabActive] = hover;
  color[ImGuiCol_TabHovered] = faded(theme::accent, 0.45f);
  color[ImGuiCol_Separator] = line;
  color[ImGuiCol_SeparatorHovered] = hover;
  color[ImGuiCol_SeparatorActive] = theme::accent;
  color[ImGuiCol_PlotLines] = theme::plotLine;
  color[ImGuiCol_PlotHistogram] = theme::accent;
  color[ImGuiCol_TableHeaderBg] = raised;
  color[ImGuiCol_TableBorderStrong] = line;
  color[ImGuiCol_TableBorderLight] = faded(line, 0.6f);
  color[ImGuiCol_TableRowBg] = faded(ground, 0);
  color[ImGuiCol_TableRowBgAlt] = faded(theme::text, 0.025f);
  color[ImGuiCol_TextSelectedBg] = faded(theme::accent, 0.35f);
  color[ImGuiCol_DragDropTarget] = theme::accent;
  color[ImGuiCol_NavHighlight] = theme::accent;
  color[ImGuiCol_ModalWindowDimBg] = faded({0, 0, 0, 1}, 0.5f);
}

}  // namespace irad
