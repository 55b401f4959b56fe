// `irad study`: what accuracy costs. `cost` measures error, time and memory over a grid of settings; `attribution`
// splits one point's error among the stages; `rq1` to `thesis` are the thesis's experiments; `merge` puts the shards of
// a study together; `pick` chooses settings by a budget, among points that were measured; `compare` holds two pictures
// against each other, layer by layer.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/devices.h"
#include "app/interrupts.h"
#include "app/stage_pictures.h"
#include "app/study.h"
#include "app/study_attribution.h"
#include "app/study_compare.h"
#include "app/study_merge.h"
#include "app/study_named.h"
#include "gi/manifest.h"
#include "renderer/base/console.h"
#include "renderer/base/error.h"
#include "renderer/base/near_match.h"
#include "renderer/base/number_text.h"
#include "renderer/base/output_file.h"

namespace irad::app {
namespace {

namespace fs = std::filesystem;

struct StudyArguments {
  std::vector<std::string> names;  ///< the study, then the scene, or folders
  MeasureArguments measure;
  AttributionArguments attribution;
  BudgetArguments budget;  ///< of pick
  std::vector<std::string> peers;
  std::optional<std::string> shard, peerSamples, facetRays, split;
  NamedArguments named;
};

/// `irad study cost SCENE`.
void costStudy(const StudyArguments& a, Machine& machine) {
  if (a.names.size() > 2) throw UsageError(fmt::format("irad study cost: unexpected argument '{}'", a.names[2]));
  a.measure.check();
  const Shard shard = a.shard ? parseShard(*a.shard) : Shard{};
  std::vector<uint32_t> peerSamples;
  for (const std::string& peer : a.peers)
    if (peer != "path-tracer")
      throw UsageError(fmt::format("--peer: unknown '{}'{}", peer, suggestion(peer, {"path-tracer"})));
  for (const std::string& samples : splitList("--peer-samples", {a.peerSamples.value_or("2,8,32,128")}))
    if (const uint32_t n = evenSamples("--peer-samples", samples); !a.peers.empty()) peerSamples.push_back(n);

  std::optional<uint64_t> facetRays;
  if (a.facetRays) facetRays = parseInteger("--facet-rays", *a.facetRays, kFewestFacetRays, kMostFacetRays);

  const uint64_t most = a.split ? parseInteger("--split", *a.split, 1, 1000) : 0;
  if (most > 0 && a.shard) throw UsageError("--split: a shard does not know the front of all points");
  const AttributionTask stages = a.attribution.task();

  DeviceSession session(machine, a.measure.settings, a.measure.device);
  const std::optional<std::string> name = a.names.size() > 1 ? std::optional(a.names[1]) : std::nullopt;
  auto [scene, task] = a.measure.open(session, "irad study cost", name);
  const SettingGrid grid(a.measure.sweeps, session.settings);
  for (size_t point = 0; most > 0 && point < grid.size(); ++point)
    requireSplittable("--split", grid.settings(point), task.view);
  const fs::path out = task.out = a.measure.out.value_or("out/study");
  const MadeFolder folder(out, kStudyLabels);
  task.shard = shard;
  task.peerSamples = std::move(peerSamples);
  task.facetRays = facetRays;
  const StopOnSignal stop;
  std::optional<StudyRun> run(std::in_place, session, scene, grid, std::move(task));
  run->measure();
  const SettingGrid measured = run->grid();
  const StudyResults results = run->results();
  const ReportNotes notes = run->notes();
  const StudyTask done = run->task();
  run.reset();  // its memory is free for the pictures of stages
  finishStudy(out, measured, results, notes, splitFront(session, scene, measured, results, done, stages, most));
  session.checkValidation();
}

/// `irad study attribution SCENE`.
void attribution(const StudyArguments& a, Machine& machine) {
  if (a.names.size() > 2) throw UsageError(fmt::format("irad study attribution: unexpected argument '{}'", a.names[2]));
  attributionStudy(machine, a.measure, a.attribution, a.names.size() > 1 ? std::optional(a.names[1]) : std::nullopt);
}

/// `irad study merge DIR... --out DIR`.
void mergeShards(const StudyArguments& arguments, Machine&) {
  const std::vector<fs::path> shards(arguments.names.begin() + 1, arguments.names.end());
  if (shards.empty()) throw UsageError("irad study merge: no folders given");
  if (!arguments.measure.out) throw UsageError("irad study merge: no --out DIR");
  const fs::path out = *arguments.measure.out;
  const MadeFolder folder(out, kStudyLabels);
  if (isNamedStudy(shards.front())) return mergeNamedStudies(shards, out);
  mergeStudies(shards, out);
  finishStudy(out, gridOf(readIdentity(out)), readResults(out), readNotes(out));
}

/// `irad study pick DIR --budget-ms X`.
void pickPoint(const StudyArguments& arguments, Machine&) {
  if (arguments.names.size() != 2) throw UsageError("irad study pick: expected one folder of a study");
  const Budget budget = arguments.budget.budget("irad study pick");
  const CostKind& cost = arguments.budget.kind();
  const fs::path folder = arguments.names[1];
  const SettingGrid grid = gridOf(readIdentity(folder));
  const std::vector<PointSummary> points = summarize(readResults(folder), grid.labels());
  const std::optional<size_t> chosen = pick(points, cost, budget);
  if (!chosen)
    throw WorkError(fmt::format("{}: none of its {} points is within that: see {}", folder.string(), points.size(),
                                (folder / "points.csv").string()));
  printChoice(points[*chosen], points, cost);
  const fs::path file = folder / "picked.json";
  writeFile(file, settingsFile(grid.settings(*chosen)));
  print("wrote       {} (for --config)\n", file.string());
}

/// `irad study compare PICTURE REFERENCE`.
void compare(const StudyArguments& a, Machine&) {
  if (a.names.size() != 3) throw UsageError("irad study compare: expected two pictures, that to be judged first");
  comparePictures(a.names[1], a.names[2], a.measure.secondReference);
}

/// `irad study rq2`, and whatever else gi/study/named.h lists.
void namedStudy(const StudyArguments& a, Machine& machine) {
  const std::string& name = a.names[0];
  if (a.names.size() > 1) throw UsageError(fmt::format("irad study {}: unexpected argument '{}'", name, a.names[1]));
  runNamedStudy(machine, name, a.measure, a.shard ? parseShard(*a.shard) : Shard{}, a.named);
}

void run(const StudyArguments& arguments, Machine& machine) {
  if (arguments.measure.device.list) return printDevices(/*json=*/false);
  struct Study {
    const char* name;
    void (*run)(const StudyArguments&, Machine&);
  };
  std::vector<Study> studies{{"cost", costStudy},
                             {"attribution", attribution},
                             {"merge", mergeShards},
                             {"pick", pickPoint},
                             {"compare", compare}};
  const std::vector<std::string> named = namedStudyNames();
  for (const std::string& name : named) studies.push_back({name.c_str(), namedStudy});
  std::vector<std::string> names;
  for (const Study& study : studies) names.emplace_back(study.name);
  if (arguments.names.empty()) throw UsageError(fmt::format("irad study: which? {}", fmt::join(names, " | ")));
  for (const Study& study : studies)
    if (arguments.names[0] == study.name) return study.run(arguments, machine);
  throw UsageError(fmt::format("unknown study '{}'{}; there are: {}", arguments.names[0],
                               suggestion(arguments.names[0], names), fmt::join(names, ", ")));
}

}  // namespace

Command studyCommand() {
  const auto arguments = std::make_shared<StudyArguments>();
  return {"study", "What accuracy costs: error against time and memory over a grid of settings",
          [arguments](Options& options) {
            options.arguments(
                "STUDY", arguments->names,
                "cost SCENE: measure a grid; attribution SCENE: split the error of one point among the stages; merge "
                "DIR...: put the shards of one study together; pick DIR: settings by "
                "a budget, from its measured points; compare PICTURE REFERENCE: two pictures layer by layer, bounce.0 "
                "to bounce.K of irad reference --bounces among them (relMSE, RMSE, mean error of each). " +
                    namedStudyHelp() +
                    ". Of a picture v "
                    "against a reference r, over all colour channels: relMSE = mean (v - r)^2 / (r^2 + e) of means "
                    "over 8 x 8 pixels, e = (0.1 mean r)^2; RMSE = sqrt mean (v - r)^2; mean error = mean (v - r); "
                    "PSNR = 20 log10(largest r / RMSE) dB; FLIP = mean LDR-FLIP (Andersson et al. 2020) of both "
                    "times 2^camera.exposure_ev within [0, 1]; +-: half a 95 % interval over seeds by Student's t");
            arguments->measure.declare(options, "out/study");
            options.value("--shard", "PART/OF", arguments->shard, "Only every OF-th point, from the PART-th on");
            options.values("--peer", "NAME", arguments->peers, "Measure another renderer too: path-tracer");
            options.value("--peer-samples", "N[,N...]", arguments->peerSamples,
                          "Its samples per pixel, even (default 2,8,32,128)");
            options.value("--facet-rays", "N", arguments->facetRays,
                          "cost: hold the facets' H, too, against a truth of its own: brute force on each point's "
                          "facets, twice, of N rays per facet each, 1000 to 7000000. Of H h against the two, r and s, "
                          "m their mean, over facets and channels: relMSE = mean (h - r)(h - s) / (m^2 + (0.1 mean "
                          "m)^2), RMSE = sqrt mean (h - r)(h - s)");
            options.value("--split", "N", arguments->split,
                          "cost: split the errors of N points on the front of first pictures among the stages, as "
                          "attribution does, beside their milliseconds; takes as long as N of those");
            arguments->attribution.declare(options);
            arguments->budget.declare(options, "pick: ");
            arguments->named.declare(options);
          },
          [arguments](Machine& machine) { run(*arguments, machine); }};
}

}  // namespace irad::app
