// `irad memory`: T Table 1 for any scene: the thesis's formula, what ours predict, what the allocator measured.
#include <fmt/format.h>

#include "app/device_session.h"
#include "app/devices.h"
#include "app/memory_table.h"
#include "app/table.h"
#include "gi/facets.h"
#include "gi/field.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/memory_report.h"
#include "gi/thesis/memory.h"
#include "renderer/base/console.h"
#include "renderer/base/number_text.h"
#include "renderer/base/output_file.h"

namespace irad::app {
namespace {

struct MemoryArguments {
  std::optional<std::string> scene, csv;
  SceneArguments sceneOptions;
  SettingArguments settings;
  DeviceArguments device;
  bool markdown = false;
};

/// What the formulas were given, and T Table 1's other M_s.
std::string facts(const DeviceSession& session, const Pipeline& pipeline) {
  const FacetList& facets = pipeline.facets();
  const glm::uvec3 dims = facets.grid.dims;
  const uint32_t rays = session.settings.matrix.gpu.rays;
  return fmt::format(
      "{}, {}\n{} x {} x {} voxels: V = {}; {} solid: M_s = {}; R = {}; {} facets; matrix {}, {} entries\n"
      "With M_s = 2^20, as in the thesis's Table 1, its eq. 31 has {:.3f} MiB. At its peak, while all was built, the "
      "device held {:.3f} MiB.\n",
      pipeline.scene().path.filename().string(), session.device->info.name, dims.x, dims.y, dims.z, facets.grid.voxels,
      facets.solidVoxels, thesisCapacity(facets.solidVoxels), rays, facets.count,
      nameOf(session.settings.matrix.format), pipeline.matrix().stats.entries,
      inMebibytes(thesisMemory(facets.grid.voxels, 1 << 20, rays).total), inMebibytes(session.device->memory().peak()));
}

void run(const MemoryArguments& arguments, Machine& machine) {
  if (arguments.device.list) return printDevices(/*json=*/false);
  arguments.sceneOptions.check();
  const auto scenePath = findScene(arguments.scene, arguments.settings.readConfig(), "box");
  std::optional<OutputFile> csv;  // first, since better to know before the work than after it
  if (arguments.csv) csv.emplace(*arguments.csv);

  DeviceSession session(machine, arguments.settings, arguments.device);
  Pipeline pipeline(*session.context, session.load(scenePath, arguments.sceneOptions), session.settings);
  session.prepare(pipeline);
  const uint64_t rays = session.settings.matrix.gpu.rays;
  const std::vector<MemoryReportRow> report = memoryReport(session.device->memory().rows(), pipeline);
  const ThesisTable table = thesisTable(report, pipeline.facets(), pipeline.field(), pipeline.lighting(), rays);
  session.progress.finish();

  const std::vector<std::vector<std::string>> cells = memoryCells(table, "mib", mebibyteNumber);
  print("{}\n{}\nWhat the thesis prints does not agree with itself; its Sponza, by its own formulas:\n",
        facts(session, pipeline),
        arguments.markdown ? markdownTable(cells) : formatTable(cells, {false, false, false, true, true, true, false}));
  for (const std::string& misprint : thesisMisprints()) print("- {}\n", misprint);
  if (csv) {
    csv->write(csvTable(memoryCells(table, "bytes", byteNumber)));
    csv->commit();
  }
  session.checkNumbers(pipeline);
  session.checkValidation();
}

}  // namespace

Command memoryCommand() {
  const auto arguments = std::make_shared<MemoryArguments>();
  return {"memory", "Show what a scene takes in memory: the thesis's formula, the prediction, what is measured",
          [arguments](Options& options) {
            options.argument("SCENE", arguments->scene, sceneHelp() + ", or check:NAME; default: box");
            options.value("--csv", "FILE", arguments->csv, "Write the table as CSV, in bytes");
            options.flag("--markdown", arguments->markdown, "Print the table as Markdown");
            arguments->sceneOptions.declare(options);
            arguments->settings.declare(options);
            arguments->device.declare(options);
          },
          [arguments](Machine& machine) { run(*arguments, machine); }};
}

}  // namespace irad::app
