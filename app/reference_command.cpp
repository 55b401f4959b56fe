// `irad reference`: pictures that do not share the error that they are held against, with their standard errors.
#include <fmt/format.h>

#include "app/device_session.h"
#include "app/devices.h"
#include "app/reference_task.h"
#include "renderer/base/error.h"

namespace irad::app {
namespace reference {
namespace fs = std::filesystem;
namespace {

void run(const Arguments& arguments, Machine& machine) {
  if (arguments.device.list) return printDevices(/*json=*/false);
  const Task task = taskOf(arguments);
  if (task.of == "triangles") return traceTriangles(arguments, task);
  const fs::path scenePath = findScene(arguments.scene, task.config, std::nullopt);
  DeviceSession session(machine, arguments.settings, arguments.device);
  Scene scene = session.load(scenePath, arguments.sceneOptions);
  const Camera camera = cameraOf(arguments, task, scene);
  if (session.settings.writeback.mode != WritebackMode::off)
    throw UsageError(
        fmt::format("--of {}: writeback.mode is to be off: reflections are no part of this truth", task.of));
  (task.of == "voxels" ? traceVoxels : solveMatrix)(arguments, task, session, std::move(scene), camera);
}

}  // namespace
}  // namespace reference

Command referenceCommand() {
  const auto arguments = std::make_shared<reference::Arguments>();
  return {
      "reference", "A picture to hold others against, with its standard error: of triangles, voxels or the matrix",
      [arguments](Options& options) {
        options.argument("SCENE", arguments->scene, sceneHelp());
        options.value("--out", "FILE", arguments->out,
                      fmt::format("The picture (default ref{0}); beside it NAME.json, the manifest. Channels R G B "
                                  "hold the first --layer, error.* its standard error per pixel (a build without "
                                  "OpenImageIO: NAME.error.pfm)",
                                  linearExtension()));
        options.value("--of", "WHAT", arguments->of,
                      "triangles: path traced, diffuse (metals are black: see --glossy and scene.lambertian), in "
                      "double precision; of the settings scene.*, sky.* and matrix.seed apply. voxels: the model with "
                      "very many rays per facet, without a matrix. "
                      "matrix: the matrix solved in double precision to 1e-12 of the mean H");
        options.values("--layer", "NAME[,NAME...]", arguments->layers,
                       "lit (default), indirect or (with --glossy or --glossy-seen) specular, as the views of these "
                       "names: indirect is "
                       "what the diffuse part of the surface seen reflects of all light but that of suns, points and "
                       "spots, specular what its lobe does. The second one has channels NAME.R, NAME.error.R, ...");
        options.flag("--glossy", arguments->glossy,
                     "triangles: the full metallic-roughness material, its lobe beside the diffuse part, as irad "
                     "render shows it");
        options.flag("--glossy-seen", arguments->glossySeen,
                     "triangles: the same of the surface that the camera sees alone; light comes to it by diffuse "
                     "reflections, as in irad render, which this tells from what that leaves out");
        options.value("--bounces", "K", arguments->bounces,
                      "triangles, matrix: also layers bounce.0 to bounce.K, the parts of lit by how often light has "
                      "been reflected before it comes to the surface seen, and each one's share of the mean. "
                      "bounce.0 has what is emitted there and the sky behind, too. What is missing to lit is of more "
                      "reflections (matrix: and the view specular). irad study compare gives the error of each");
        options.value("--spp", "N", arguments->spp,
                      "End with N samples per pixel (triangles; default 256), or N rays per facet that count "
                      "(voxels; default 100000)");
        options.value("--seconds", "S", arguments->seconds, "End after the pass during which S seconds have passed");
        options.value("--noise", "E", arguments->noise,
                      "End when the relative standard error is E at most. triangles: the root of the mean over "
                      "pixels and channels of error^2 / (value^2 + (a tenth of the picture's mean)^2), from 16 "
                      "samples on. voxels: the mean standard error of H over the mean H, from 16 frames on");
        options.flag("--resume", arguments->resume,
                     "triangles, voxels: go on from NAME.state, which every run leaves beside the picture, to the "
                     "bits of one run; from the start where there is none. Refused where scene, settings or (of "
                     "triangles) camera and size, (of voxels) device differ. Without it every run starts anew");
        options.flag("--centred", arguments->centred,
                     "triangles: rays through the middle of pixels, as irad render samples, not all over them");
        options.flag("--facets", arguments->facets,
                     "voxels, matrix: also NAME.irradiance.npy, H per facet in matrix order (and "
                     "NAME.standard_error.npy)");
        arguments->picture.declareView(options);
        arguments->sceneOptions.declare(options);
        arguments->settings.declare(options);
        arguments->device.declare(options);
      },
      [arguments](Machine& machine) { reference::run(*arguments, machine); }};
}

}  // namespace irad::app
