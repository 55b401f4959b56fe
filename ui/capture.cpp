#include "ui/capture.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <utility>

#include "gi/picture.h"
#include "gi/plan.h"
#include "renderer/base/error.h"
#include "renderer/base/image_io.h"
#include "renderer/base/output_file.h"

namespace irad {
namespace {

/// One side's pictures and manifest, into a folder that exists.
void saveSide(Session& session, Pipeline& pipeline, const std::vector<ViewInfo>& chosen,
              const std::filesystem::path& folder, const Program& program, const Progress& progress) {
  Context& context = session.context;
  if (!pipeline.current())
    throw WorkError("Not saved: the picture is not of these settings, what they call for has not been rebuilt.");
  Manifest manifest = manifestOf(session, pipeline, "render", program);
  manifest.frames = 1;
  Targets targets(context, session.targets.size);
  pipeline.solvedAfresh(progress, [&] {
    pipeline.settleReflections(manifest.cameras.front(), targets, progress);
    for (const ViewInfo& view : chosen) {
      const float done = static_cast<float>(manifest.views.size()) / static_cast<float>(chosen.size());
      if (!progress(view.label, done)) throw WorkError("cancelled");
      Frame frame = context.beginUntimed();
      pipeline.render(frame, manifest.cameras.front(), view.view, targets, {.shareSurfaces = true});
      frame.submitAndWait();
      for (const std::filesystem::path& path : writePicture(context, targets, view, folder / view.name).paths)
        manifest.files.push_back(path.filename().string());
      manifest.views.emplace_back(view.name);
      if (view.hasRange())
        manifest.viewRanges.push_back(rangeJson(context, targets, view, pipeline.settings(), view.name));
    }
    manifest.details.emplace_back("effects", planJson(pipeline.plan()));
  });
  writeFile(folder / "manifest.json", manifest.toJson());
}

/// The window's, under the name of the scene's camera or the bookmark that it stands at; elsewhere it has none.
Camera cameraOf(const Session& session) {
  Camera camera = session.camera.camera();
  const std::vector<Camera> all = session.cameras();
  const auto here = [&](Camera other) {
    other.name = camera.name;
    return other == camera;
  };
  const auto chosen = static_cast<size_t>(session.sceneCamera);  // of several in one place
  auto at = all.end();
  if (chosen < all.size() && here(all[chosen]))
    at = all.begin() + session.sceneCamera;
  else
    at = std::ranges::find_if(all, here);
  camera.name = at != all.end() ? at->name : "";
  return camera;
}

/// Returns the folder; throws on failure. In a comparison each side has a folder of its own in it.
std::filesystem::path save(Session& session, const std::vector<ViewInfo>& chosen, const std::filesystem::path& parent,
                           const Program& program, const Progress& progress) {
  OutputFolder folder(parent / session.pipeline->scene().path.stem());
  if (session.comparison) {
    for (const auto& [side, name] : {std::pair{&session.sideA(), "a"}, {&session.sideB(), "b"}}) {
      makeFolder(folder.temporary() / name);
      saveSide(session, *side->pipeline, chosen, folder.temporary() / name, program, progress);
    }
  } else {
    saveSide(session, *session.pipeline, chosen, folder.temporary(), program, progress);
  }
  return std::filesystem::absolute(folder.commit()).lexically_normal();
}

}  // namespace

Manifest manifestOf(const Session& session, const Pipeline& pipeline, std::string subcommand, const Program& program) {
  return {.program = program,
          .subcommand = std::move(subcommand),
          .time = std::time(nullptr),
          .device = &session.context.device.info,
          .scene = &pipeline.scene(),
          .settings = &pipeline.settings(),
          .cpuDevice = session.context.device.isCpu,
          .size = session.targets.size,
          .cameras = {cameraOf(session)},
          .reference = session.reference && !session.reference->path.empty() ? session.reference.get() : nullptr,
          .shaders = session.context.shaders.modified()};
}

void saveCapture(Session& session, bool allViews, const std::filesystem::path& parent, const Program& program,
                 const Progress& progress) {
  if (!session.built) return;
  std::vector<ViewInfo> chosen;
  const auto drawable = [&](const ViewInfo& view) {
    return (!view.isFrom(FROM_PICTURE) || session.pipeline->hasReference()) &&
           (!view.isFrom(FROM_ORACLE) || session.pipeline->knowsIrradiance());
  };
  for (const ViewInfo& view : views())
    if (view.view == session.view || (allViews && drawable(view))) chosen.push_back(view);
  try {
    const std::filesystem::path folder = save(session, chosen, parent, program, progress);
    for (const Side* side : session.sides()) session.settingsSaved(side->pipeline->settings());  // the manifest's
    session.note(fmt::format("Saved {}{} to {}", allViews ? fmt::format("{} views", chosen.size()) : chosen[0].label,
                             session.comparison ? " of both sides" : "", folder.string()),
                 folder);
  } catch (const Error& error) {
    if (session.work->cancel)
      session.note("Saving was cancelled; no folder was made.");
    else
      session.error(error.what());
  }
}

void saveScreenshot(Context& context, const Image& image, const std::filesystem::path& file) {
  const std::vector<std::byte> bytes = download(context, image);
  std::filesystem::path stem = file;
  stem.replace_extension();
  writeDisplay(stem, {image.desc.width, image.desc.height},
               {reinterpret_cast<const glm::u8vec4*>(bytes.data()), bytes.size() / sizeof(glm::u8vec4)});
}

}  // namespace irad
