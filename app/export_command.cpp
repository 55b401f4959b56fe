// `irad export`: volumes, matrix and facets for other programs, the record of a voxel as JSON, with a manifest; or a
// scene with its images decoded.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/device_session.h"
#include "app/devices.h"
#include "gi/check/check.h"
#include "gi/export.h"
#include "gi/facets.h"
#include "gi/inspect.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/pipeline.h"
#include "gi/plan.h"
#include "renderer/base/console.h"
#include "renderer/base/error.h"
#include "renderer/base/json_reader.h"
#include "renderer/base/near_match.h"
#include "renderer/base/output_file.h"
#include "renderer/targets.h"

namespace irad::app {
namespace fs = std::filesystem;
namespace {

struct ExportArguments {
  std::optional<std::string> scene, out, cache, inspect;
  std::vector<std::string> volumes, formats;
  bool matrix = false, facets = false;
  SceneArguments sceneOptions;
  PictureArguments picture;
  SettingArguments settings;
  DeviceArguments device;
};

bool contains(const std::vector<std::string>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::vector<Volume> parseVolumes(const std::vector<std::string>& names) {
  const auto& all = EnumNames<Volume>::names;
  std::vector<std::string> known(all.begin(), all.end());
  known.emplace_back("all");
  std::vector<Volume> out;
  const auto add = [&](size_t i) {
    const auto volume = static_cast<Volume>(i);
    if (std::find(out.begin(), out.end(), volume) == out.end()) out.push_back(volume);
  };
  for (const std::string& name : splitList("--volume", names)) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) throw UsageError(fmt::format("unknown volume '{}'{}", name, suggestion(name, known)));
    const auto index = static_cast<size_t>(found - known.begin());
    if (index < all.size()) {
      add(index);
    } else {
      for (size_t i = 0; i < all.size(); ++i) add(i);
    }
  }
  return out;
}

/// The formats asked for. Each export is written in those of them that it has, which must be one at least; a format
/// that no export has is an error.
std::vector<std::string> parseFormats(const ExportArguments& arguments) {
  static const std::vector<std::string> known{"npy", "vdb", "csv"};
  const std::vector<std::string> wanted =
      arguments.formats.empty() ? std::vector<std::string>{"npy"} : splitList("--format", arguments.formats);
  for (const std::string& name : wanted)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw UsageError(fmt::format("unknown format '{}'{}", name, suggestion(name, known)));
  if (contains(wanted, "vdb") && !canWriteVdb()) throw UsageError("--format vdb: this build has no OpenVDB (IRAD_VDB)");
  const auto check = [&](const char* option, bool given, const std::vector<std::string>& has) {
    const bool written = std::any_of(has.begin(), has.end(), [&](const auto& name) { return contains(wanted, name); });
    if (given && !written) throw UsageError(fmt::format("{} is written as {}", option, fmt::join(has, " or ")));
    if (!given && has.size() > 1 && contains(wanted, has[1]))
      throw UsageError(fmt::format("--format {} is for {}, which is not given", has[1], option));
  };
  check("--volume", !arguments.volumes.empty(), {"npy", "vdb"});
  check("--facets", arguments.facets, {"npy", "csv"});
  check("--matrix", arguments.matrix, {"npy"});
  return wanted;
}

/// Where the arrays lie in the world: [z, y, x] is the voxel at world position origin + edge (x, y, z).
std::string gridJson(const Scene& scene, const Grid& grid) {
  const glm::dvec3 corner = scene.origin + glm::dvec3(grid.origin);
  nlohmann::ordered_json json;
  json["dims"] = {grid.dims.x, grid.dims.y, grid.dims.z};
  json["edge"] = static_cast<double>(grid.edge);
  json["origin"] = {corner.x, corner.y, corner.z};
  json["scene_origin"] = {scene.origin.x, scene.origin.y, scene.origin.z};
  return jsonText(json);
}

/// inspect.json: the record of one voxel, and its light sweep by sweep. `voxel` is in the grid and holds facets.
fs::path exportRecord(DeviceSession& session, const Pipeline& pipeline, const Inspector& inspector,
                      const glm::uvec3& voxel, const fs::path& folder) {
  const SolveHistory history =
      replaySolve(*session.context, pipeline, inspector.places().facetsOf(voxel),
                  [&](const char* stage, float fraction) { return session.progress(stage, fraction); });
  const fs::path path = folder / "inspect.json";
  writeFile(path, inspectJson(inspector.voxel(voxel), inspector.grid(), pipeline.facets().encoding, history));
  return path;
}

void exportFiles(const ExportArguments& arguments, Machine& machine, const std::vector<Volume>& volumes,
                 const std::vector<std::string>& formats, const std::optional<glm::uvec3>& inspected,
                 const fs::path& scenePath) {
  DeviceSession session(machine, arguments.settings, arguments.device);
  if (session.settings.solver.method == SolverMethod::bruteForce && (arguments.matrix || arguments.inspect))
    throw UsageError(fmt::format("{}: solver.method = brute_force has no matrix; take solver.method=matrix",
                                 arguments.matrix ? "--matrix" : "--inspect"));
  Scene scene = session.load(scenePath, arguments.sceneOptions);
  const std::vector<Camera> cameras = arguments.picture.resolveCameras(session.config, scene);
  const fs::path out = arguments.out.value_or("out");
  const MadeFolder folder(out);
  // Exports need matrix and field, whether or not a picture calls for them.
  for (EffectMode* asked : {&session.settings.effects.matrix, &session.settings.effects.field})
    if (*asked == EffectMode::automatic) *asked = EffectMode::on;
  Pipeline pipeline(*session.context, std::move(scene), session.settings);
  session.prepare(pipeline);
  // What is written back is what one camera sees.
  const glm::uvec2 size = arguments.picture.resolveSize(session.config);
  const bool writesBack = static_cast<bool>(pipeline.lighting().writeback.used);
  if (writesBack) {
    if (cameras.size() > 1) throw UsageError("--camera: what is written back is what one camera sees; give one");
    Targets targets(*session.context, size);
    pipeline.settleReflections(cameras.front(), targets,
                               [&](const char* stage, float done) { return session.progress(stage, done); });
  }
  if (arguments.matrix && !pipeline.matrix()) throw UsageError("--matrix: effects.matrix = off, there is no matrix");
  if (std::ranges::find(volumes, Volume::distance) != volumes.end() && !pipeline.field())
    throw UsageError("--volume distance: effects.field = off, there is no distance field");
  session.checkNumbers(pipeline);  // before anything is written: readers of arrays do not look at them
  std::optional<Inspector> inspector;
  if (inspected) inspector.emplace(*session.context, pipeline).requireFacets(*inspected);

  // The manifest is written last and vouches for the rest, so that of an earlier run is removed first.
  removeFile(out / "manifest.json");
  std::vector<fs::path> written;
  for (const Volume volume : volumes) {
    const VolumeValues values =
        readVolume(*session.context, volume, pipeline.facets(), pipeline.field(), pipeline.lighting());
    if (contains(formats, "npy")) written.push_back(writeVolumeNpy(values, out));
    if (contains(formats, "vdb")) written.push_back(writeVolumeVdb(values, pipeline.scene().origin, out));
  }
  const auto append = [&](const std::vector<fs::path>& files) {
    written.insert(written.end(), files.begin(), files.end());
  };
  if (arguments.matrix) append(exportMatrix(*session.context, pipeline.matrix(), out));
  if (arguments.facets) {
    const FacetTable table = readFacets(*session.context, pipeline.facets(), pipeline.lighting());
    if (contains(formats, "npy")) append(writeFacetsNpy(table, out));
    if (contains(formats, "csv")) written.push_back(writeFacetsCsv(table, out));
  }
  if (inspected) written.push_back(exportRecord(session, pipeline, *inspector, *inspected, out));

  Manifest manifest = session.manifest("export", pipeline);
  manifest.details.emplace_back("effects", planJson(pipeline.plan()));
  for (const Volume volume : volumes) {
    manifest.arguments.emplace_back("--volume");
    manifest.arguments.emplace_back(nameOf(volume));
  }
  if (arguments.matrix) manifest.arguments.emplace_back("--matrix");
  if (arguments.facets) manifest.arguments.emplace_back("--facets");
  if (inspected) {
    manifest.arguments.emplace_back("--inspect");
    manifest.arguments.push_back(*arguments.inspect);
  }
  for (const std::string& format : arguments.formats) {
    manifest.arguments.emplace_back("--format");
    manifest.arguments.push_back(format);
  }
  if (writesBack) {
    manifest.size = size;
    manifest.cameras = cameras;
  }
  manifest.details.emplace_back("grid", gridJson(pipeline.scene(), pipeline.facets().grid));
  for (const fs::path& path : written) manifest.files.push_back(path.filename().string());
  writeFile(out / "manifest.json", manifest.toJson());
  written.push_back(out / "manifest.json");
  session.progress.finish();
  for (const fs::path& path : written) print("wrote       {}\n", path.string());
  session.checkValidation();
}

void run(const ExportArguments& arguments, Machine& machine) {
  if (arguments.device.list) return printDevices(/*json=*/false);
  arguments.sceneOptions.check();
  arguments.picture.check();
  const std::vector<Volume> volumes = parseVolumes(arguments.volumes);
  const std::vector<std::string> formats = parseFormats(arguments);
  std::optional<glm::uvec3> inspected;
  if (arguments.inspect) inspected = parseVoxel("--inspect", *arguments.inspect);
  const bool files = !volumes.empty() || arguments.matrix || arguments.facets || inspected;
  if (!files && !arguments.cache)
    throw UsageError("nothing to export: give --volume, --matrix, --facets, --inspect or --cache");
  const Config config = arguments.settings.readConfig();
  const fs::path scenePath = findScene(arguments.scene, config, std::nullopt);
  if (arguments.cache) {
    const Settings settings = arguments.settings.resolve(config, /*cpuDevice=*/true);
    writeSceneCache(openScene(scenePath, arguments.sceneOptions.load(config, settings)), *arguments.cache);
    print("wrote       {}\n", *arguments.cache);
  }
  if (files) exportFiles(arguments, machine, volumes, formats, inspected, scenePath);
}

}  // namespace

Command exportCommand() {
  const auto arguments = std::make_shared<ExportArguments>();
  return {"export", "Write volumes, the matrix or facets for numpy, OpenVDB, spreadsheets, or a voxel's record as JSON",
          [arguments](Options& options) {
            options.argument("SCENE", arguments->scene, sceneHelp());
            options.value("--out", "DIR", arguments->out, "Folder for the results (default: out)");
            options.values("--volume", "NAME[,NAME...]", arguments->volumes,
                           "radiosity, irradiance, albedo, normal, emission, distance, or all (repeatable): NAME.npy, "
                           "float32 [z, y, x(, 3)], or NAME.vdb");
            options.flag("--matrix", arguments->matrix,
                         "indptr.npy, indices.npy, data.npy: what scipy.sparse.csr_matrix takes");
            options.flag("--facets", arguments->facets,
                         "facet_NAME.npy or facets.csv: one row per facet, in matrix order");
            options.values("--format", "NAME[,NAME...]", arguments->formats,
                           "npy, vdb (OpenVDB: volumes), csv (facets); repeatable; default: npy");
            options.value("--inspect", "X,Y,Z", arguments->inspect,
                          "inspect.json: all that is known of one voxel, its facets, their rows and columns of the "
                          "matrix, and H after every sweep from the dark");
            options.value("--cache", "FILE", arguments->cache,
                          "The scene with its images decoded (.irscene), for builds without image decoders");
            arguments->sceneOptions.declare(options);
            arguments->picture.declareView(options);
            arguments->settings.declare(options);
            arguments->device.declare(options);
          },
          [arguments](Machine& machine) { run(*arguments, machine); }};
}

}  // namespace irad::app
