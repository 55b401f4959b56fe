#include "ui/imgui_layer.h"

#include <backends/imgui_impl_glfw.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include "renderer/base/error.h"
#include "shaders/shared/ui.h"
#include "ui/theme.h"

namespace irad {

static_assert(sizeof(UiVertex) == sizeof(ImDrawVert));
static_assert(sizeof(UiDraw) <= 128);

/// Of a frame, its lists one after another.
struct ImGuiLayer::Triangles {
  struct Range {
    uint32_t first, count, texture;
    VkImage image;
    ImageUse use;
    glm::vec4 clip;
    bool operator==(const Range&) const = default;
  };
  std::vector<ImDrawVert> vertices;
  std::vector<uint32_t> indices;
  std::vector<Range> ranges;
  bool operator==(const Triangles& other) const {
    return ranges == other.ranges && indices == other.indices && vertices.size() == other.vertices.size() &&
           std::memcmp(vertices.data(), other.vertices.data(), vertices.size() * sizeof(ImDrawVert)) == 0;
  }
};

ImGuiLayer::ImGuiLayer(Context& context, GLFWwindow* window)
    : context_(context), ended_(std::make_unique<Triangles>()), drawn_(std::make_unique<Triangles>()) {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // the layout is computed from the window's size, see ui/layout.h
  io.BackendRendererName = "irad";
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
  io.ConfigWindowsMoveFromTitleBarOnly = true;
  io.ConfigInputTextCursorBlink = false;  // a window that waits for a key draws nothing
  ImGui_ImplGlfw_InitForOther(window, /*install_callbacks=*/true);
}

Image imageOf(Context& context, const char* name, glm::uvec2 size, std::span<const glm::u8vec4> pixels) {
  Image image(context.device, ImageDesc{.name = name,
                                        .subsystem = Subsystem::Ui,
                                        .format = VK_FORMAT_R8G8B8A8_UNORM,
                                        .width = size.x,
                                        .height = size.y,
                                        .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
  upload(context, image, std::as_bytes(pixels));
  return image;
}

ImGuiLayer::~ImGuiLayer() {
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

void ImGuiLayer::setScale(float scale) {
  // Quarter steps: each step rasterizes the fonts anew.
  scale = std::clamp(std::round(scale * 4.0f) / 4.0f, 0.75f, 4.0f);
  if (scale == scale_) return;
  scale_ = scale;
  applyTheme(ImGui::GetStyle(), scale_);
  buildFonts();
}

void ImGuiLayer::buildFonts() {
  ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
  fonts.Clear();
  addFonts(fonts, scale_);
  unsigned char* pixels = nullptr;
  int width = 0, height = 0;
  fonts.GetTexDataAsRGBA32(&pixels, &width, &height);
  const size_t count = static_cast<size_t>(width) * static_cast<size_t>(height);
  atlas_ = imageOf(context_, "ui font atlas", {width, height}, {reinterpret_cast<const glm::u8vec4*>(pixels), count});
  fonts.SetTexID(nullptr);  // slot 0
}

void ImGuiLayer::takeInput() {
  ImGui_ImplGlfw_NewFrame();
}

void ImGuiLayer::beginFrame() {
  textures_.assign(1, {&atlas_, {.blends = true}});
  ImGuiIO& io = ImGui::GetIO();
  // Tab is a key of the window's own but in a text field, from which it leads to the next.
  if (!io.WantTextInput) io.KeysDown[io.KeyMap[ImGuiKey_Tab]] = false;
  passWheelOn();
  ImGui::NewFrame();
}

void ImGuiLayer::passWheelOn() {
  ImGuiIO& io = ImGui::GetIO();
  const ImGuiContext& g = *ImGui::GetCurrentContext();
  if (io.MouseWheel == 0 || io.KeyCtrl) return;
  const auto scrolls = [](const ImGuiWindow& w) {
    return w.ScrollMax.y > 0 && (w.Flags & ImGuiWindowFlags_NoScrollWithMouse) == 0;
  };
  ImGuiWindow* window = g.WheelingWindow ? g.WheelingWindow : g.HoveredWindow;
  const auto child = [](const ImGuiWindow& w) { return (w.Flags & ImGuiWindowFlags_ChildWindow) && w.ParentWindow; };
  while (window && child(*window) && !scrolls(*window)) window = window->ParentWindow;
  if (!window || !child(*window)) return;
  const bool ends = io.MouseWheel > 0 ? window->Scroll.y <= 0 : window->Scroll.y >= window->ScrollMax.y;
  if (!ends) return;
  ImGuiWindow* outer = window->ParentWindow;
  while (child(*outer) && !scrolls(*outer)) outer = outer->ParentWindow;
  if (!scrolls(*outer)) return;
  const float lines = 5 * ImGui::GetFontSize() * io.MouseWheel;  // ImGui's own pace
  ImGui::SetScrollY(outer, std::clamp(outer->Scroll.y - lines, 0.0f, outer->ScrollMax.y));
  io.MouseWheel = 0;
}

void* ImGuiLayer::texture(const Image& image, ImageUse use) {
  textures_.push_back({&image, use});
  return reinterpret_cast<void*>(textures_.size() - 1);
}

bool ImGuiLayer::endFrame() {
  ImGui::Render();
  const ImDrawData& data = *ImGui::GetDrawData();

  // All lists into one vertex and one index array; indices are made absolute on the way.
  Triangles& t = *ended_;
  t.vertices.clear();
  t.indices.clear();
  t.ranges.clear();
  for (int l = 0; l < data.CmdListsCount; ++l) {
    const ImDrawList& list = *data.CmdLists[l];
    const auto base = static_cast<uint32_t>(t.vertices.size());
    t.vertices.insert(t.vertices.end(), list.VtxBuffer.begin(), list.VtxBuffer.end());
    for (const ImDrawCmd& command : list.CmdBuffer) {
      if (command.UserCallback) continue;  // none is installed
      const auto texture = static_cast<uint32_t>(reinterpret_cast<uintptr_t>(command.TextureId));
      const Texture& shown = textures_.at(texture);
      const ImVec4& clip = command.ClipRect;
      t.ranges.push_back({static_cast<uint32_t>(t.indices.size()),
                          command.ElemCount,
                          texture,
                          shown.image->handle,
                          shown.use,
                          {clip.x, clip.y, clip.z, clip.w}});
      const ImDrawIdx* from = list.IdxBuffer.Data + command.IdxOffset;
      const size_t written = t.indices.size();
      t.indices.resize(written + command.ElemCount);
      std::transform(from, from + command.ElemCount, t.indices.begin() + static_cast<ptrdiff_t>(written),
                     [first = base + command.VtxOffset](ImDrawIdx index) { return first + index; });
    }
  }
  return t != *drawn_;
}

void ImGuiLayer::draw(Frame& frame, const Image& target) {
  const auto filled = [&](const char* name, const auto& values) -> const Buffer& {
    const size_t bytes = values.size() * sizeof(values[0]);
    const Buffer& buffer = frame.hostFilled(name, Subsystem::Ui, bytes);
    if (bytes > 0) std::memcpy(buffer.mapped, values.data(), bytes);
    return buffer;
  };
  const Buffer &vertices = filled("ui vertices", ended_->vertices), &indices = filled("ui indices", ended_->indices);
  const std::vector<Triangles::Range>& ranges = ended_->ranges;

  // Where a run of draws with one image begins, a pass begins: there is no descriptor indexing on Mesa's CPU driver,
  // and a branch over images would have it sample each of them.
  const glm::vec2 size(static_cast<float>(target.desc.width), static_cast<float>(target.desc.height));
  const VkSampler linear = sampler(context_.device, {.u = Wrap::Clamp, .v = Wrap::Clamp, .mips = false});
  const VkSampler nearest = sampler(
      context_.device, {.u = Wrap::Clamp, .v = Wrap::Clamp, .linearMag = false, .linearMin = false, .mips = false});
  const ImVec4 background = ImGui::GetStyleColorVec4(ImGuiCol_WindowBg);
  std::optional<ClearColor> clear = ClearColor{background.x, background.y, background.z, 1.0f};
  for (size_t begin = 0, end = 0; begin < ranges.size(); begin = end) {
    const uint32_t texture = ranges[begin].texture;
    while (end < ranges.size() && ranges[end].texture == texture) ++end;
    Pass pass = frame.pass("UI");
    pass.shaders({"ui/imgui.vert", "ui/imgui.frag"})
        .color(target, std::exchange(clear, std::nullopt))
        .alphaBlend()
        .sample(*textures_.at(texture).image, textures_[texture].use.nearest ? nearest : linear);
    const uint64_t vertexArray = pass.in(vertices), indexArray = pass.in(indices);
    pass.run([&](Commands& commands) {
      for (size_t i = begin; i < end; ++i) {
        const Triangles::Range& range = ranges[i];
        const glm::vec2 low = glm::max(glm::floor(glm::vec2(range.clip.x, range.clip.y)), glm::vec2(0.0f));
        const glm::vec2 high = glm::min(glm::ceil(glm::vec2(range.clip.z, range.clip.w)), size);
        if (range.count == 0 || high.x <= low.x || high.y <= low.y) continue;
        const glm::uvec2 corner(low), extent(high - low);
        commands.scissor(corner.x, corner.y, extent.x, extent.y);
        commands.push(UiDraw{vertexArray, indexArray, 2.0f / size, textures_.at(texture).use.blends ? 0.0f : 1.0f});
        commands.draw(range.count, range.first);
      }
    });
  }
  std::swap(ended_, drawn_);
}

}  // namespace irad
