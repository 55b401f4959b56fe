#include "ui/outline.h"

#include <algorithm>
#include <cmath>

#include "renderer/depth_pass.h"
#include "renderer/forward.h"
#include "renderer/scene/nodes.h"
#include "shaders/shared/ui.h"
#include "ui/imgui.h"
#include "ui/imgui_layer.h"
#include "ui/layout.h"
#include "ui/pixel_ray.h"
#include "ui/session.h"
#include "ui/theme.h"

namespace irad {

void drawOutline(Session& session, Frame& frame, float scale) {
  Outline& outline = session.outline;
  const glm::uvec2 size = session.targets.size;
  if (!session.object || !session.pipeline || size.x == 0) return;
  Pipeline& pipeline = *session.pipeline;
  const Outline::Of of{&pipeline,
                       pipeline.revision(),
                       *session.object,
                       session.shown,
                       size,
                       std::max(1, static_cast<int>(std::lround(1.5f * scale))),
                       showsSurfaces(session)};
  if (outline.of == of) return;
  const Scene& scene = pipeline.scene();
  outline.of.reset();
  if (*session.object >= scene.nodes.size()) return;
  const std::vector<Draw> draws = drawsOf(scene, scene.nodes, *session.object);
  if (draws.empty()) return;  // hidden

  Context& context = frame.context();
  if (outline.picture.desc.width != size.x || outline.picture.desc.height != size.y || !outline.picture) {
    const auto image = [&](const char* name, VkFormat format, VkImageUsageFlags usage) {
      return Image(context.device, ImageDesc{.name = name,
                                             .subsystem = Subsystem::Ui,
                                             .format = format,
                                             .width = size.x,
                                             .height = size.y,
                                             .usage = usage | VK_IMAGE_USAGE_SAMPLED_BIT});
    };
    outline.depth = image("outline depth", VK_FORMAT_D32_SFLOAT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
    outline.picture = image("outline", VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_USAGE_STORAGE_BIT);
  }
  if (!outline.camera) outline.camera = Buffer(context.device, "outline camera", Subsystem::Ui, sizeof(GpuCamera));
  frame.pass("UI").update(outline.camera, makeGpuCamera(scene, session.shown, size));
  drawDepth(frame, pipeline.device(),
            {.stage = "UI",
             .target = outline.depth,
             .projections = outline.camera,
             .cull = true,
             .alphaTest = pipeline.device().anyAlphaMask,
             .draws = &draws});
  SamplerDesc nearest{Wrap::Clamp, Wrap::Clamp};
  nearest.linearMag = nearest.linearMin = nearest.mips = nearest.linearMips = false;
  const ImVec4& color = theme::accent;
  frame.pass("UI")
      .shader("ui/outline.comp")
      .sample(outline.depth, sampler(context.device, nearest))
      .sample(of.surfaces ? session.targets.depth : outline.depth, sampler(context.device, nearest))
      .write(outline.picture)
      .push(OutlinePush{.size = size, .color_ = {color.x, color.y}, .blue = color.z, .reach = of.reach})
      .dispatch(size);
  outline.of = of;
}

void showOutline(Session& session, ImGuiLayer& layer, const Rect& where) {
  Outline& outline = session.outline;
  if (!session.object) {
    // Here, where this frame has not named them yet.
    outline = {};
    return;
  }
  if (!outline.of || outline.of->object != *session.object || outline.of->pipeline != session.pipeline.get()) return;
  const glm::vec2 end = where.position + where.size;
  ImGui::GetWindowDrawList()->AddImage(layer.texture(outline.picture, {.blends = true}),
                                       {where.position.x, where.position.y}, {end.x, end.y});
}

}  // namespace irad
