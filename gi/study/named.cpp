// The table of named studies: questions, what the thesis found, experiments.
#include "gi/study/named.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "gi/study/claims.h"
#include "renderer/base/error.h"
#include "renderer/base/near_match.h"

namespace irad {
namespace {

using Texts = std::vector<std::string>;

std::string sweepOf(const char* setting, const std::vector<uint32_t>& values) {
  return fmt::format("{}={}", setting, fmt::join(values, ","));
}
Texts joined(Texts a, const Texts& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

const Texts kThesis{"preset=thesis"}, kOurs{"preset=balanced"};
// Arena is seen from the cave that lies behind its entrance, where all light has bounced (T 7.1).
struct SceneOfStudy {
  const char *scene, *camera;
};
const SceneOfStudy kScenes[] = {{"box", "main"}, {"park", "main"}, {"arena", "main"}, {"sponza", ""}};

/// The same of each of the thesis's scenes.
std::vector<Experiment> inAllScenes(const Experiment& pattern, bool sponza = true) {
  std::vector<Experiment> out;
  for (const SceneOfStudy& s : kScenes) {
    if (!sponza && std::string_view(s.scene) == "sponza") continue;
    Experiment e = pattern;
    e.name = s.scene + pattern.name, e.scene = s.scene, e.camera = s.camera;
    out.push_back(e);
  }
  return out;
}

std::vector<Experiment> bruteForce(const StudyScale& s) {
  // One sweep from the dark is one bounce.
  const GridTexts grids{{"solver.max_sweeps=1,1000"},
                        {"solver.method=brute_force", sweepOf("solver.frames", s.frames)}};
  std::vector<Experiment> out;
  for (const char* scene : {"box", "sponza"})
    out.push_back(
        {.name = fmt::format("{}-thesis", scene), .scene = scene, .camera = "", .settings = kThesis, .grids = grids});
  return out;
}
std::vector<Experiment> buildTime(const StudyScale& s) {
  std::vector<Experiment> out = inAllScenes({.name = "-thesis", .settings = kThesis});
  for (Experiment& e : inAllScenes({.name = "-ours", .settings = kOurs}, s.sponzaByDefaults))
    out.push_back(std::move(e));
  return out;
}
std::vector<Experiment> resolution(const StudyScale& s) {
  const GridTexts grids{{sweepOf("voxel.resolution", s.resolutions)}};
  return {{.name = "box-thesis", .scene = "box", .camera = "main", .settings = kThesis, .grids = grids},
          {.name = "box-ours", .scene = "box", .camera = "main", .settings = kOurs, .grids = grids},
          {.name = "sponza-thesis", .scene = "sponza", .camera = "", .settings = kThesis, .grids = grids}};
}
std::vector<Experiment> rowSize(const StudyScale& s) {
  const GridTexts grids{{sweepOf("matrix.rays", s.rows)}};
  return {{.name = "hard-thesis", .scene = "box-hard", .camera = "main", .settings = kThesis, .grids = grids},
          {.name = "average-thesis", .scene = "box", .camera = "main", .settings = kThesis, .grids = grids},
          {.name = "hard-ours", .scene = "box-hard", .camera = "main", .settings = kOurs, .grids = grids},
          {.name = "average-ours", .scene = "box", .camera = "main", .settings = kOurs, .grids = grids}};
}
std::vector<Experiment> traversal(const StudyScale&) {
  return inAllScenes({.name = "-thesis",
                      .settings = kThesis,
                      .grids = {{"matrix.traversal=dda"}, {"matrix.traversal=sdf", "field.method=jfa,chebyshev"}},
                      .movedRays = true});
}
std::vector<Experiment> normals(const StudyScale&) {
  const std::string encodings = "voxel.normals=axis6,axis26,oct8,oct16";
  return {{.name = "box-thesis", .scene = "box", .camera = "main", .settings = kThesis, .grids = {{encodings}}},
          {.name = "curved-thesis", .scene = "box", .camera = "close", .settings = kThesis, .grids = {{encodings}}},
          {.name = "curved-ours", .scene = "box", .camera = "close", .settings = kOurs, .grids = {{encodings}}},
          {.name = "sponza-thesis", .scene = "sponza", .camera = "", .settings = kThesis, .grids = {{encodings}}},
          {.name = "voxels-thesis",
           .scene = "box",
           .camera = "main",
           .settings = kThesis,
           .grids = {{"voxel.method=raster,conservative"}, {"thesis.literal=true"}}}};
}
std::vector<Experiment> relight(const StudyScale& s) {
  const GridTexts one{{"solver.max_sweeps=1,1000"}};  // one iteration, as a frame of the thesis has it; all of them
  std::vector<Experiment> out = inAllScenes({.name = "-thesis", .settings = kThesis, .grids = one});
  for (Experiment& e : inAllScenes({.name = "-ours", .settings = kOurs, .grids = one}, s.sponzaByDefaults))
    out.push_back(std::move(e));
  return out;
}
std::vector<Experiment> relaxation(const StudyScale&) {
  const GridTexts grids{{"solver.lambda=0.5,0.6,0.7,0.8,0.9,1"}};
  return {{.name = "box-thesis", .scene = "box", .camera = "main", .settings = kThesis, .grids = grids},
          {.name = "park-thesis", .scene = "park", .camera = "main", .settings = kThesis, .grids = grids},
          {.name = "sponza-thesis", .scene = "sponza", .camera = "", .settings = kThesis, .grids = grids},
          {.name = "box-ours", .scene = "box", .camera = "main", .settings = kOurs, .grids = grids}};
}
std::vector<Experiment> sampling(const StudyScale&) {
  const GridTexts grids{{"sample.filter=linear,blur", "sample.premultiplied=false,true"}};
  return {{.name = "box-thesis", .scene = "box", .camera = "main", .settings = kThesis, .grids = grids},
          {.name = "curved-thesis", .scene = "box", .camera = "close", .settings = kThesis, .grids = grids},
          {.name = "sponza-thesis", .scene = "sponza", .camera = "", .settings = kThesis, .grids = grids}};
}
std::vector<Experiment> edgeRemoval(const StudyScale&) {
  const GridTexts grids{{"scatter.edge_removal=false,true"}};
  std::vector<Experiment> out{
      {.name = "box-thesis", .scene = "box", .camera = "main", .settings = kThesis, .grids = grids},
      {.name = "park-thesis", .scene = "park", .camera = "main", .settings = kThesis, .grids = grids},
      {.name = "sponza-thesis", .scene = "sponza", .camera = "", .settings = kThesis, .grids = grids}};
  out.push_back({.name = "reflections",
                 .scene = "box",
                 .camera = "close",
                 .view = "specular",
                 .settings = kThesis,
                 .grids = grids,
                 .truth = TruthKind::OwnSettings});
  return out;
}
std::vector<Experiment> writeback(const StudyScale&) {
  const GridTexts grids{{"writeback.mode=off,mask,compute"}};
  // Little direct light and a sky to be reflected, as in T 7.13; skies go with the rule `triangles`. The mask's k goes
  // with the scene's unit: docs/method.md 8.
  const Texts sky{"sky.source=constant", "sky.intensity=1", "writeback.k=4"};
  return {{.name = "box-thesis",
           .scene = "box",
           .camera = "close",
           .view = "lit",
           .settings = joined(kThesis, {"writeback.k=4"}),
           .grids = grids,
           .truth = TruthKind::OwnSettings,
           .truthSettings = {"writeback.mode=compute"},
           .flicker = true},
          {.name = "box-sky",
           .scene = "box",
           .camera = "close",
           .view = "lit",
           .settings = joined(kOurs, sky),
           .grids = grids,
           .truth = TruthKind::OwnSettings,
           .truthSettings = joined(sky, {"writeback.mode=compute"}),
           .flicker = true}};
}
std::vector<Experiment> cycles(const StudyScale& s) {
  const Texts diffuse{"scene.lambertian=true", "scene.double_sided=true"};
  std::vector<Experiment> out;
  for (const char* preset : {"thesis", "balanced"}) {
    if (std::string_view(preset) == "balanced" && !s.sponzaByDefaults) continue;
    out.push_back({.name = fmt::format("sponza-{}", std::string_view(preset) == "thesis" ? "thesis" : "ours"),
                   .scene = "sponza",
                   .camera = "",
                   .view = "lit",
                   .settings = joined({fmt::format("preset={}", preset)}, diffuse),
                   .grids = {},
                   .truth = TruthKind::Cycles});
  }
  // T 7.4's scenes, split; EEVEE has no indirect light to split off. In the Box the light of the lamp's faces is direct
  // to Cycles and indirect here, so that these two parts are not the same there.
  for (const char* scene : {"box", "park"})
    for (const auto& [engine, view] : {std::pair("cycles", "lit"),
                                       {"cycles", "direct"},
                                       {"cycles", "indirect"},
                                       {"cycles", "specular"},
                                       {"eevee", "lit"},
                                       {"eevee", "direct"}}) {
      const std::string_view part(view);
      if (scene == std::string_view("box") && *engine == 'c' && (part == "direct" || part == "indirect")) continue;
      out.push_back({.name = fmt::format("{}-{}-{}", scene, engine, view),
                     .scene = scene,
                     .camera = "main",
                     .view = view,
                     .settings = kThesis,
                     .grids = {},
                     .truth = TruthKind::Blender,
                     .engine = *engine == 'c' ? "CYCLES" : "EEVEE"});
    }
  return out;
}
std::vector<Experiment> tables(const StudyScale&) {
  // One iteration per frame, as the thesis times it.
  const Texts settings = joined(kThesis, {"solver.max_sweeps=1"});
  std::vector<Experiment> out = inAllScenes({.name = "",
                                             .view = "lit",
                                             .settings = settings,
                                             .grids = {},
                                             .truth = TruthKind::Itself,
                                             .longTimes = true,
                                             .tables = true});
  for (const char* scene : {"sponza", "box"})
    out.push_back({.name = fmt::format("writeback-{}", scene),
                   .scene = scene,
                   .camera = "",
                   .view = "lit",
                   .settings = joined(settings, {"writeback.mode=mask"}),
                   .grids = {},
                   .truth = TruthKind::Itself,
                   .longTimes = true});
  return out;
}

}  // namespace

const std::vector<StudyScale>& studyScales() {
  static const std::vector<StudyScale> scales{{.name = "full",
                                               .resolutions = {128, 256, 384},
                                               .rows = {128, 256, 384},
                                               .voxels = 256,
                                               .rays = 384,
                                               .width = 1200,
                                               .height = 1200,
                                               .samples = 256,
                                               .truthVoxels = 512,
                                               .truthRays = 512,
                                               .seeds = 3,
                                               .repeats = 30,
                                               .tableRepeats = 100,
                                               .stillFrames = 60,
                                               .frames = {1, 4, 16, 64},
                                               .sponzaByDefaults = true,
                                               .settings = {}},
                                              {.name = "small",
                                               .resolutions = {12, 24, 36},
                                               .rows = {16, 32, 48},
                                               .voxels = 24,
                                               .rays = 48,
                                               .width = 64,
                                               .height = 64,
                                               .samples = 128,
                                               .truthVoxels = 48,
                                               .truthRays = 96,
                                               .seeds = 3,
                                               .repeats = 2,
                                               .tableRepeats = 6,
                                               .stillFrames = 8,
                                               .frames = {1, 4, 16, 32},
                                               .sponzaByDefaults = false,
                                               .settings = {"light.shadow_resolution=256"}}};
  return scales;
}

const StudyScale& findScale(std::string_view name) {
  std::vector<std::string> names;
  for (const StudyScale& scale : studyScales()) {
    if (name == scale.name) return scale;
    names.emplace_back(scale.name);
  }
  throw UsageError(fmt::format("--scale: unknown '{}'{}", name, suggestion(name, names)));
}

const std::vector<NamedStudy>& namedStudies() {
  using namespace claims;
  static const std::vector<NamedStudy> studies{
      {"rq1",
       "How do pictures compare with those of Cycles and EEVEE?",
       {{"7.4, RQ1", "Close to Cycles, at least in diffuse light; shadow edges and shading constants differ.",
         cyclesIsMatched},
        {"7.4", "EEVEE is far off, since it has no indirect light.", eeveeIsFarOff}},
       cycles},
      {"rq2",
       "How does the relight compare with brute force?",
       {{"7.5, RQ2", "Brute force gives a quite different picture, and it is brute force that is wrong.",
         bruteForceDiffers},
        {"7.5", "The likely reason: brute force carries little light beyond the first bounces.",
         bruteForceLosesBounces}},
       bruteForce},
      {"rq3",
       "How long does the matrix take to build?",
       {{"RQ3", "A handful of seconds in most scenes.", buildTakesSeconds},
        {"RQ3", "Too long to build it anew while geometry moves.", buildTakesLongerThanAFrame}},
       buildTime},
      {"rq4",
       "What does the resolution of voxels do to the matrix, to its time and to quality?",
       {{"7.6", "Set-up time is almost proportional to the number of voxels, the cube of the resolution.",
         timeIsCubicInResolution},
        {"5.14", "Memory of the matrix grows as the cube of the resolution.", matrixIsCubicInResolution},
        {"7.6, RQ4", "Quality changes subtly: low resolutions look better than one would expect.", resolutionIsSubtle}},
       resolution},
      {"rq5",
       "What does the length of rows do to time and quality?",
       {{"7.7, RQ5", "Time grows almost linearly with the length of rows.", timeIsLinearInRows},
        {"7.7, RQ5", "In hard light (little of it comes through a gap) longer rows quiet the noise.",
         rowsQuietHardLight},
        {"7.7", "In average light the difference is almost unnoticeable.", rowsDoLittleInAverageLight}},
       rowSize},
      {"rq6",
       "What changes when form factors are traced by the distance field instead of cell by cell?",
       {{"7.8, RQ6", "Marching through the field is faster by 2 on average.", sdfIsTwiceAsFast},
        {"RQ6", "It loses no quality to speak of.", sdfLosesNoQuality},
        {"7.8", "Indirect shadows come out weaker with the field, for a reason not found.", sdfWeakensShadows}},
       traversal},
      {"rq7",
       "What changes with the encoding of normals?",
       {{"RQ7", "Quality hardly depends on it, even with few directions.", normalsMatterLittle},
        {"7.9, RQ7", "Octahedral normals are better on curved surfaces.", octahedralIsBetterOnCurves},
        {"7.9", "Some voxels of the Box are wrong, for a reason not found.", voxelsAreMissing}},
       normals},
      {"rq8",
       "How long does a relight take?",
       {{"RQ8", "2 to 4 ms an iteration, on its GPU.", relightTakesTwoToFourMs}},
       relight},
      {"rq9",
       "Which relaxation factor gives the most accurate result?",
       {{"7.10, RQ9", "By eye 0.6 to 0.8 (text) or 0.7 to 0.9 (conclusion); it depends on the scene.", bestLambda},
        {"7.10", "Why not 1 is left open; rows that are not normalized were suspected.", bestLambdaOfNormalizedRows}},
       relaxation},
      {"rq10",
       "What does blurring what is sampled do?",
       {{"7.12, RQ10", "Blurred and premultiplied is the best of the four modes.", blurPremultipliedIsBest},
        {"7.12, RQ10", "Premultiplied alpha takes the dark edges away.", premultiplyingMendsEdges}},
       sampling},
      {"rq11",
       "What does edge removal do to time and quality?",
       {{"7.11, RQ11", "It removes the artefact at the edges of shadows.", edgeRemovalMendsEdges},
        {"7.11", "Its time was to be looked at, and no figure is given.", edgeRemovalTime},
        {"7.11, RQ11", "Reflections lose the direct light.", edgeRemovalDarkensReflections}},
       edgeRemoval},
      {"rq12",
       "What does writing reflections back do?",
       {{"7.13, Table 10", "The forward stage takes several times as long.", writebackCostsAMultiple},
        {"7.13, RQ12", "It flickers.", writebackFlickers},
        {"7.13", "What it adds is underwhelming.", writebackAddsLittle}},
       writeback},
      {"tables", "The thesis's Tables 1 to 3 and 6 to 10: memory, scenes, milliseconds by stage", {}, tables}};
  return studies;
}

const NamedStudy* findNamedStudy(std::string_view name) {
  for (const NamedStudy& study : namedStudies())
    if (name == study.name) return &study;
  return nullptr;
}

const char* toString(Judgement verdict) {
  switch (verdict) {
    case Judgement::Agrees:
      return "agrees";
    case Judgement::Disagrees:
      return "disagrees";
    case Judgement::Answered:
      return "answers what was open";
    case Judgement::Open:
      return "open";
  }
  return "";
}

}  // namespace irad
