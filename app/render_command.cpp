// `irad render`: pictures, timings.csv, memory.csv, manifest.json.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <sstream>

#include "app/device_session.h"
#include "app/devices.h"
#include "app/reference.h"
#include "gi/check/check.h"
#include "gi/facets.h"
#include "gi/inspect.h"
#include "gi/legend.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/memory_report.h"
#include "gi/picture.h"
#include "gi/pipeline.h"
#include "gi/plan.h"
#include "gi/watch.h"
#include "renderer/base/console.h"
#include "renderer/base/error.h"
#include "renderer/base/number_text.h"
#include "renderer/base/output_file.h"
#include "renderer/frame/frame.h"
#include "renderer/targets.h"

namespace irad::app {
namespace fs = std::filesystem;
namespace {

struct RenderArguments {
  std::optional<std::string> scene, out, inspect;
  SceneArguments sceneOptions;
  SettingArguments settings;
  DeviceArguments device;
  PictureArguments picture;
  ReferenceArgument reference;
  std::vector<std::string> views;
  bool legend = false;
};

/// A camera's name as part of a file name, different from those before it.
std::string fileName(const Camera& camera, size_t index, std::set<std::string>& used) {
  std::string name;
  for (const char c : camera.name) {
    const bool plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
    name += plain ? c : '_';
  }
  if (name.empty()) name = fmt::format("camera{}", index);
  std::string unique = name;
  for (int n = 2; !used.insert(unique).second; ++n) unique = fmt::format("{}-{}", name, n);
  return unique;
}

/// Renders `frames` frames and writes the last, even where it holds NaN: the picture shows them (red).
PictureFiles renderPicture(DeviceSession& session, Pipeline& pipeline, const Camera& camera, const ViewInfo& view,
                           uint32_t frames, bool withLegend, Targets& targets, const fs::path& stem) {
  for (uint32_t i = 0; i < frames; ++i) {
    const auto start = std::chrono::steady_clock::now();
    Frame frame = session.context->begin(i);
    pipeline.render(frame, camera, view.view, targets, {.shareSurfaces = frames == 1});
    frame.submitAndWait();
    const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
    session.timings.endFrame(i, /*setup=*/false, elapsed.count());
  }
  if (withLegend && view.toneMapped() && !view.isFrom(FROM_PICTURE))
    return writePicture(*session.context, targets, view, stem, nullptr, pipeline.plan().nothingDiffuse);
  if (!withLegend || !view.hasRange()) return writePicture(*session.context, targets, view, stem);
  const Legend legend = legendOf(*session.context, targets, view, session.settings);
  return writePicture(*session.context, targets, view, stem, &legend);
}

double meanSetup(const Timings& timings, std::string_view stage) {
  double ms = 0;
  for (const Timings::Row& row : timings.rows())
    if (row.kind == WorkKind::Setup && row.stage.starts_with(stage)) ms += row.stats.mean;
  return ms;
}

/// Milliseconds of a stage in all calls.
double totalOf(const Timings& timings, std::string_view stage) {
  double ms = 0;
  for (const Timings::Row& row : timings.rows())
    if (row.stage == stage) ms += row.stats.mean * static_cast<double>(row.stats.samples);
  return ms;
}

/// What a camera's pictures write back, once light and pictures agree.
std::string describe(const WritebackRounds& rounds, const Pipeline& pipeline) {
  const WritebackReport& w = *pipeline.lighting().writeback.report;
  std::string writers;
  for (uint32_t n = 0; n < WRITEBACK_BINS; ++n)
    if (w.writers[n] > 0)
      writers += fmt::format("{}{} by {}{}", writers.empty() ? "" : ", ", w.writers[n], n,
                             n + 1 == WRITEBACK_BINS ? " or more" : "");
  return fmt::format("{} of {} visible facets written ({}), largest {:.4g} W/m^2, {} rounds{}", w.written(),
                     w.visible(), writers, w.largest, rounds.rounds,
                     rounds.settled ? "" : fmt::format(": the last still changed it by {:.3g}", w.change));
}

void summarize(const DeviceSession& session, const Pipeline& pipeline) {
  const FacetList& facets = pipeline.facets();
  const MatrixStats& matrix = pipeline.matrix().stats;
  const SolveReport& solve = pipeline.lighting().report;
  const glm::uvec3 dims = facets.grid.dims;
  print("grid        {} x {} x {} voxels, edge {:.6g}\n", dims.x, dims.y, dims.z, facets.grid.edge);
  print("facets      {} in {} solid voxels{}\n", facets.count, facets.solidVoxels,
        facets.clampedAlbedo ? fmt::format(", albedo of {} clamped to [0, .98]", facets.clampedAlbedo) : "");
  if (pipeline.obeyed().solver.method == SolverMethod::bruteForce) {
    print("matrix      none, with solver.method=brute_force\n");
  } else {
    print("matrix      {} entries, {:.1f} MiB used of {:.1f} MiB, largest row {}\n", matrix.entries,
          inMebibytes(matrix.bytesUsed), inMebibytes(matrix.bytesAllocated), matrix.largestRow);
  }
  const double buildMs = meanSetup(session.timings, "GI BuildMatrix");
  if (buildMs > 0)
    print("rays        {:.2f} M in {:.1f} ms: {:.2f} Mrays/s\n", static_cast<double>(matrix.rays) * 1e-6, buildMs,
          static_cast<double>(matrix.rays) * 1e-3 / buildMs);
  if (solve.frames > 0)
    print(
        "brute force {} frames of {} rays per facet, {:.1f} ms each, standard error {:.3g} W/m^2 of mean H {:.4g}, "
        "largest {:.4g} W/m^2{}\n",
        solve.frames, pipeline.obeyed().matrix.gpu.rays, totalOf(session.timings, "GI BruteForce") / solve.frames,
        solve.standardError, solve.meanH, solve.largestH, solve.converged ? "" : " (tolerance not reached)");
  else
    print("solve       {} sweeps, bound {:.3g} W/m^2 of mean H {:.4g}, largest {:.4g} W/m^2{}\n", solve.sweeps,
          solve.bound, solve.meanH, solve.largestH, solve.converged ? "" : " (tolerance not reached)");
  if (solve.energy) print("energy      {}\n", describe(*solve.energy, facets.grid.edge));
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);  // ru_maxrss: KiB
  print("memory      {:.1f} MiB on the device, {:.1f} MiB at the process's peak\n",
        inMebibytes(session.device->memory().used()), static_cast<double>(usage.ru_maxrss) / 1024);
}

/// Refuses views that were `asked` for by name and have nothing to be drawn from, and leaves out such of the others,
/// which `all` or a manifest brings; a note that says so, or nothing. UsageError where none is left.
std::string takeDrawable(std::vector<ViewInfo>& chosen, const std::vector<std::string>& asked, bool reference,
                         const fs::path& scene) {
  std::vector<std::string> leftOut;
  std::string why;
  std::erase_if(chosen, [&](const ViewInfo& view) {
    try {
      requireInput(view, reference, scene);
    } catch (const UsageError& error) {
      if (std::ranges::find(asked, view.name) != asked.end()) throw;
      leftOut.emplace_back(view.name);
      why = error.what();
      return true;
    }
    return false;
  });
  if (chosen.empty()) throw UsageError(why);
  return leftOut.empty()
             ? ""
             : fmt::format("left out, for want of a reference picture or an oracle: {}", fmt::join(leftOut, ", "));
}

void run(const RenderArguments& arguments, Machine& machine) {
  if (arguments.device.list) return printDevices(/*json=*/false);
  arguments.sceneOptions.check();
  arguments.picture.check();
  if (arguments.legend && !canDrawText()) throw UsageError("--legend: this build draws no text (IRAD_OIIO)");
  const Config early = arguments.settings.readConfig();
  const std::vector<std::string> wanted = !arguments.views.empty() ? splitList("--view", arguments.views)
                                          : !early.views.empty()   ? early.views
                                                                   : std::vector<std::string>{"lit"};
  std::vector<ViewInfo> chosen = findViews(wanted);
  const glm::uvec2 size = arguments.picture.resolveSize(early);
  const uint32_t frames = arguments.picture.resolveFrames(early, 1);
  std::optional<glm::uvec3> inspected;
  if (arguments.inspect) inspected = parseVoxel("--inspect", *arguments.inspect);
  const fs::path scenePath = findScene(arguments.scene, early, std::nullopt);
  const std::string leftOut = takeDrawable(chosen, arguments.views.empty() ? std::vector<std::string>{} : wanted,
                                           arguments.reference.given(early), scenePath);

  DeviceSession session(machine, arguments.settings, arguments.device);
  if (!leftOut.empty()) session.progress.note(leftOut);
  const std::optional<ReferencePicture> reference = arguments.reference.read(session.config, session.progress);
  if (reference && arguments.reference.file) requireSize(*reference, size);  // a manifest's was scaled by the window
  Scene scene = session.load(scenePath, arguments.sceneOptions);
  const std::vector<Camera> cameras = arguments.picture.resolveCameras(session.config, scene);
  if (reference && std::ranges::any_of(chosen, [](const ViewInfo& view) { return view.isFrom(FROM_PICTURE); }))
    for (const Camera& camera : cameras) requireSubject(*reference, camera, reference->of);
  const fs::path out = arguments.out.value_or("out");
  const MadeFolder folder(out);

  ExpectedIrradiance expected = expectedIrradiance(scene);
  Pipeline pipeline(*session.context, std::move(scene), session.settings, std::move(expected));
  if (reference) pipeline.setReference(reference->picture.size, reference->picture.pixels, reference->of);
  session.prepare(pipeline);
  for (const std::string& line : pipeline.plan().nothingDiffuse) session.progress.note("note: " + line);
  if (std::ranges::find(wanted, "all") == wanted.end())
    for (const ViewInfo& view : chosen)
      if (const std::string missing = whatIsMissing(view, pipeline.obeyed()); !missing.empty())
        session.progress.note(fmt::format("warning: the view {} is empty. {}", view.name, missing));
  if (inspected) {
    const Inspector inspector(*session.context, pipeline);
    inspector.requireFacets(*inspected);
    session.settings.view.facet = inspector.places().facetsOf(*inspected).front();
    pipeline.set(session.settings);
    session.prepare(pipeline);
  }
  Targets targets(*session.context, size);

  // The manifest is written last and vouches for the rest, so that of an earlier run is removed first.
  removeFile(out / "manifest.json");
  Manifest manifest = session.manifest("render", pipeline);
  std::vector<fs::path> written;
  std::set<std::string> used;
  std::vector<std::string> badPictures, writtenBack;
  for (size_t c = 0; c < cameras.size(); ++c) {
    const std::string prefix = cameras.size() > 1 ? fileName(cameras[c], c, used) + "." : "";
    const WritebackRounds rounds = pipeline.settleReflections(
        cameras[c], targets, [&](const char* stage, float done) { return session.progress(stage, done); });
    if (rounds.rounds > 0) writtenBack.push_back(prefix + describe(rounds, pipeline));
    for (const ViewInfo& view : chosen) {
      session.progress(view.name, 0);
      const PictureFiles files = renderPicture(session, pipeline, cameras[c], view, frames, arguments.legend, targets,
                                               out / (prefix + view.name));
      written.insert(written.end(), files.paths.begin(), files.paths.end());
      if (!files.bad.empty())
        badPictures.push_back(fmt::format("numerical watch: picture {}{}: {}", prefix, view.name, files.bad));
      if (view.hasRange())
        manifest.viewRanges.push_back(rangeJson(*session.context, targets, view, session.settings, prefix + view.name));
    }
  }

  std::ostringstream timings;
  writeCsv(timings, session.timings.rows());
  writeFile(out / "timings.csv", timings.str());
  written.push_back(out / "timings.csv");
  writeFile(out / "memory.csv", memoryCsv(memoryReport(session.device->memory().rows(), pipeline)));
  written.push_back(out / "memory.csv");

  manifest.details.emplace_back("effects", planJson(pipeline.plan()));  // of these pictures
  if (arguments.legend) manifest.arguments.emplace_back("--legend");
  manifest.size = size;
  manifest.frames = frames;
  manifest.cameras = cameras;
  for (const ViewInfo& view : chosen) manifest.views.emplace_back(view.name);
  if (reference) manifest.reference = &*reference;
  for (const fs::path& path : written) manifest.files.push_back(path.filename().string());
  writeFile(out / "manifest.json", manifest.toJson());
  written.push_back(out / "manifest.json");

  session.progress.finish();
  summarize(session, pipeline);
  for (const std::string& line : writtenBack) print("writeback   {}\n", line);
  for (const fs::path& path : written) print("wrote       {}\n", path.string());
  session.checkNumbers(pipeline, badPictures);
  session.checkValidation();
}

}  // namespace

Command renderCommand() {
  const auto arguments = std::make_shared<RenderArguments>();
  return {"render", "Render pictures of a scene, with timings, memory table and manifest",
          [arguments](Options& options) {
            options.argument("SCENE", arguments->scene, sceneHelp());
            options.value("--out", "DIR", arguments->out, "Folder for the results (default: out)");
            options.values("--view", "NAME[,NAME...]", arguments->views,
                           "Views to render, or `all` (repeatable; default: lit); `irad views` lists them");
            options.flag(
                "--legend", arguments->legend,
                "Draw the legend into the PNGs of views with a range, and why pictures of light are black where they "
                "are");
            options.value("--inspect", "X,Y,Z", arguments->inspect,
                          "Voxel whose first facet's row the view matrix-row shows (sets view.facet)");
            arguments->picture.declare(options);
            arguments->reference.declare(options);
            arguments->sceneOptions.declare(options);
            arguments->settings.declare(options);
            arguments->device.declare(options);
          },
          [arguments](Machine& machine) { run(*arguments, machine); }};
}

}  // namespace irad::app
