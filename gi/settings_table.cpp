// The settings, a row each: SETTING(member of Settings, name, range of a number, help, what a change redoes).
// Below it what panels call those that have letters for names, and what each group is about.
#include <algorithm>
#include <type_traits>

#include "gi/setting_words.h"
#include "gi/settings.h"

namespace irad {
namespace {

template <class T>
constexpr SettingKind kindOf() {
  if constexpr (std::is_enum_v<T>) return SettingKind::choice;
  if constexpr (std::is_same_v<T, bool> || std::is_same_v<T, Flag>) return SettingKind::toggle;
  if constexpr (std::is_same_v<T, uint32_t>) return SettingKind::integer;
  if constexpr (std::is_same_v<T, float>) return SettingKind::number;
}

template <class T>
constexpr std::span<const char* const> choicesOf() {
  if constexpr (std::is_enum_v<T>)
    return EnumNames<T>::names;
  else
    return {};
}

/// `Member`: from Settings, const or not, to the setting in it.
template <class Member>
constexpr Setting row(Member, const char* name, const SettingRange& range, const char* help, Redo redo) {
  using T = std::remove_cvref_t<decltype(Member{}(std::declval<Settings&>()))>;
  return {.name = name,
          .kind = kindOf<T>(),
          .range = range,
          .help = help,
          .redo = redo,
          .choices = choicesOf<T>(),
          .get = [](const Settings& s) { return static_cast<double>(Member{}(s)); },
          .set = [](Settings& s, double value) { Member{}(s) = static_cast<T>(value); }};
}
template <class Member>
constexpr Setting row(Member member, const char* name, const char* help, Redo redo) {
  return row(member, name, SettingRange{}, help, redo);
}

#define SETTING(member, ...) \
  row(                       \
      [](auto& s) -> auto& { return s.member; }, __VA_ARGS__)

/// Of a box's corners, m.
constexpr double kFarthest = 1e9;

namespace rows {  // alone sees the stages' names without Redo::, whatever is compiled with it
using enum Redo;
constexpr Setting kTable[] = {
    SETTING(voxel.resolution, "voxel.resolution", {8, 1022, "voxels"}, "Voxels along the scene's longest axis (N).",
            Voxels),
    SETTING(voxel.method, "voxel.method",
            "raster: each triangle is drawn along its dominant axis, as the thesis does it, which leaves pin-holes; "
            "conservative: every voxel that a triangle touches, watertight.",
            Voxels),
    SETTING(voxel.normals, "voxel.normals",
            "How a facet's normal is stored: as the nearest of 6 or 26 directions, or in an octahedral grid of 8 or 16 "
            "bits.",
            Voxels),
    SETTING(field.method, "field.method",
            "Distance field that rays with matrix.traversal=sdf read. chebyshev: exact, along the axes; jfa: by jump "
            "flooding, as the thesis makes it.",
            Field),
    SETTING(matrix.format, "matrix.format",
            "padded: the thesis's rows of a fixed length, 8 bytes per hit; csr: rows of the exact length, 4 bytes per "
            "distinct column.",
            Matrix),
    SETTING(matrix.gpu.rays, "matrix.rays", {1, 4096, "rays"},
            "Rays traced per facet; the noise of a form factor falls with their square root.", Matrix),
    SETTING(
        matrix.gpu.hitRule, "matrix.hit_rule",
        "What rays meet, and so what facets are. triangles: from the true surface the first triangle; a voxel has a "
        "facet for each side of the surface in it. thesis: from one voxel above the facet the first solid voxel with a "
        "front face; a voxel has one facet, lookups leak. thesis alone takes voxel.method=raster, "
        "matrix.format=padded and thesis.literal.",
        Voxels),
    SETTING(matrix.gpu.traversal, "matrix.traversal",
            "dda: cell by cell; sdf: skips the empty space that the field proves.", Matrix),
    SETTING(matrix.gpu.jitter, "matrix.jitter",
            "Shift the set of directions in each voxel by a hash of its own (Cranley-Patterson rotation).", Matrix),
    SETTING(matrix.emitterSampling, "matrix.emitter_sampling",
            "Light that facets get straight from emissive ones: by rays to points of the emitters instead of the "
            "matrix row; auto: where fewer than a tenth of the facets emit and the sum agrees with the matrix.",
            Emission),
    SETTING(matrix.emitterSamples, "matrix.emitter_samples", {1, 256, "rays"}, "Rays per facet to the emitters.",
            Emission),
    SETTING(matrix.gpu.seed, "matrix.seed", {0, 4294967295.0},
            "Number from which the random directions of rays are made (--seed): another one gives other noise.",
            Matrix),
    SETTING(solver.method, "solver.method",
            "matrix: form factors are traced once and kept; brute_force: none are kept, matrix.rays rays per facet are "
            "traced anew in every frame and H is the mean of what they bring, with its standard error as a view "
            "(standard-error).",
            Matrix),
    SETTING(solver.frames, "solver.frames", {1, 100000, "frames"},
            "Most frames of brute force; it ends before where the standard error is below solver.tolerance.", Solve),
    SETTING(solver.gpu.lambda, "solver.lambda", {0, 2},
            "Artistic gain: B = lambda (M + rho (D + H)); 1 leaves the physics alone.", Solve),
    SETTING(solver.gpu.omega, "solver.omega", {0.05, 1},
            "Under-relaxation: a sweep goes this share of the way to its result; the solution stays the same.", Solve),
    SETTING(solver.gpu.flush, "solver.flush", {0, 1e-3, "W/m^2", /*logarithmic=*/true},
            "Values of light smaller than this become exactly 0.", Solve),
    SETTING(
        solver.tolerance, "solver.tolerance", {1e-7, 1, "", /*logarithmic=*/true},
        "The solver stops when its error bound on H (brute force: the mean standard error) is below this share of the "
        "mean H, by the facets' areas.",
        Solve),
    SETTING(solver.sweepsPerFrame, "solver.sweeps_per_frame", {1, 1000, "sweeps"},
            "Jacobi sweeps per frame of the window.", Solve),
    SETTING(solver.maxSweeps, "solver.max_sweeps", {1, 100000, "sweeps"}, "Most sweeps of a headless solve.", Solve),
    SETTING(solver.kernel, "solver.kernel",
            "tree: 64 threads per row and a sum in shared memory, as the thesis does it; subgroup: one subgroup per "
            "row; row: one invocation per row.",
            Solve),
    SETTING(solver.acceleration, "solver.acceleration",
            "anderson: every 4 sweeps their results are mixed, so that the least residual is left; off: Jacobi alone.",
            Solve),
    SETTING(scatter.edgeRemoval, "scatter.edge_removal",
            "Subtract direct and emitted light from the volume that shading samples with matrix.hit_rule=thesis: no "
            "blocky shadow edges.",
            Scatter),
    SETTING(sample.gpu.filter_, "sample.filter",
            "How shading looks up indirect light: the nearest facet, between voxel centres, or between them after a "
            "blur over "
            "3 x 3 x 3 voxels. With matrix.hit_rule=triangles that goes only as far as the noise of the rays calls "
            "for, and "
            "costs one product with the matrix per relight.",
            Scatter),
    SETTING(sample.gpu.premultiplied, "sample.premultiplied",
            "Divide what is looked up by its alpha, the share of it that lies on surfaces, so that empty voxels do not "
            "darken it.",
            Shade),
    SETTING(sample.gpu.normalOffset, "sample.normal_offset", {0, 2, "voxels"},
            "How far a point is moved along its normal before its indirect light is looked up, with "
            "matrix.hit_rule=thesis.",
            Shade),
    SETTING(sample.emitters, "sample.emitters",
            "Who gives a pixel the light that comes straight from emissive faces. facets: the voxels around it, like "
            "the rest of H; pixels: the faces' true outlines, with shadow rays of each pixel; auto: pixels where the "
            "voxels around differ much, near a lamp and at the rim of its shadows.",
            Shade),
    SETTING(sample.emitterRays, "sample.emitter_rays", {1, 256, "rays"}, "Shadow rays per pixel to emissive triangles.",
            Shade),
    SETTING(specular.mode, "specular.mode",
            "Where specular rays are traced: in the forward fragment shader, as the thesis does it, or in compute over "
            "the G-buffer.",
            Shade),
    SETTING(specular.gpu.rays, "specular.rays", {1, 64, "rays"},
            "Specular rays per pixel; a quarter as many again go to emissive faces.", Shade),
    SETTING(specular.gpu.traversal, "specular.traversal",
            "How specular rays step through the grid; as matrix.traversal.", Shade),
    SETTING(specular.gpu.maxRoughness, "specular.max_roughness", {0, 1},
            "Rougher surfaces take the diffuse irradiance instead of rays; 1: none does.", Shade),
    SETTING(specular.gpu.metalRoughness, "specular.metal_roughness", {0, 1},
            "As specular.max_roughness, for metals, whose reflections are most of what one sees of them.", Shade),
    SETTING(specular.gpu.fade, "specular.fade", {0, 1},
            "Range of roughness below specular.max_roughness (and metal_roughness) over which rays give way to the "
            "diffuse irradiance.",
            Shade),
    SETTING(specular.gpu.threshold, "specular.threshold", {0, 1, "", /*logarithmic=*/true},
            "No rays where reflectance F0 times indirect irradiance H is below this share of the scene's largest H.",
            Shade),
    SETTING(specular.gpu.filter_, "specular.filter", "Smooths the noise of traced reflections, but not across edges.",
            Shade),
    SETTING(writeback.mode, "writeback.mode",
            "Reflections as a source of the facets that show them, so that they light the scene. mask: the fragments "
            "nearest to voxel centres write theirs, as the thesis does it; compute: the mean over a facet's pixels.",
            Solve),
    SETTING(writeback.gpu.alpha, "writeback.alpha", {0, 1},
            "Of the mask: exponent by which a fragment's distance from the camera counts, in metres; 0: not at all, "
            "and the "
            "mask is the same in every unit.",
            Shade),
    SETTING(
        writeback.gpu.k, "writeback.k", {0, 1000, "", /*logarithmic=*/true},
        "Of the mask: weight of a fragment's distance from the voxel's centre against that from the camera. It goes "
        "with the scene's unit: a fragment r metres away writes within (1 - threshold) r^alpha / k voxels.",
        Shade),
    SETTING(writeback.gpu.threshold, "writeback.threshold", {0, 1},
            "Of the mask: least score of a fragment that writes (tau); 1: none but those in a voxel's very centre.",
            Shade),
    SETTING(light.shadowResolution, "light.shadow_resolution", {64, 8192, "texels"},
            "Shadow-map size; point lights use half per cube face.", Gather),
    SETTING(light.shadowFilter, "light.shadow_filter",
            "How shadow maps of lights without a size are read. hard: one comparison; pcf: camera.pcf x camera.pcf of "
            "them; vsm: by the mean and variance of distance over as many texels, in four times the memory.",
            Gather),
    SETTING(light.bleedReduction, "light.bleed_reduction", {0, 0.95},
            "Shadow filter vsm: shares of light up to this count as shadow, so that less light bleeds in where shadows "
            "lie over each other.",
            Gather),
    SETTING(light.points, "light.points", {1, 1024, "points"},
            "Points of a light with a size (its angle or radius) that a pixel or facet looks at.", Gather),
    SETTING(sky.source, "sky.source",
            "Light from where no surface is. constant: of one radiance; image: a picture of the whole sphere (--sky); "
            "preetham: a clear sky, by Preetham, Shirley and Smits. With matrix.hit_rule=triangles.",
            Gather),
    SETTING(sky.intensity, "sky.intensity", {0, 1e6},
            "Factor on the sky; of a constant one its radiance, W/(m^2 sr). Preetham's comes in kcd/m^2, one to one.",
            Gather),
    SETTING(sky.rotation, "sky.rotation", {-360, 360, "degrees"}, "Turns the sky about the vertical axis, +Y.", Gather),
    SETTING(sky.red, "sky.red", {0, 1}, "Colour of a constant sky, linear.", Gather),
    SETTING(sky.green, "sky.green", {0, 1}, "Colour of a constant sky, linear.", Gather),
    SETTING(sky.blue, "sky.blue", {0, 1}, "Colour of a constant sky, linear.", Gather),
    SETTING(sky.turbidity, "sky.turbidity", {2, 10}, "Haze of Preetham's sky: 2 clear, 6 hazy.", Gather),
    SETTING(sky.coupled, "sky.coupled",
            "The sun of Preetham's sky is the scene's first, if one shines, and the sky as bright as goes with it.",
            Gather),
    SETTING(sky.elevation, "sky.elevation", {0, 90, "degrees"}, "Height of the sun of Preetham's sky.", Gather),
    SETTING(sky.azimuth, "sky.azimuth", {-360, 360, "degrees"},
            "Direction of the sun of Preetham's sky, from -Z towards +X.", Gather),
    SETTING(
        sky.ground, "sky.ground", {0, 1},
        "Diffuse albedo of the ground below the horizon of Preetham's sky, which that sky and its coupled sun light.",
        Gather),
    SETTING(camera.exposureEv, "camera.exposure", {-16, 16, "EV"},
            "Exposure of the displayed picture; EXR files stay linear. auto: camera.auto_exposure = true.", Nothing),
    SETTING(camera.autoExposure, "camera.auto_exposure",
            "Exposes each picture of light by itself, so that 95 % of it are darker than the tone curve's bend; "
            "camera.exposure comes on top.",
            Nothing),
    SETTING(
        camera.glassLayers, "camera.glass_layers", {1, 16},
        "Blended surfaces, one behind the other, that a picture shows; those behind are left out. Where a scene has "
        "such surfaces its pictures are drawn once for each and once more.",
        Nothing),
    SETTING(camera.gpu.toneCurve, "camera.tone_curve", "linear, or Khronos PBR Neutral.", Nothing),
    SETTING(camera.gpu.shadowBias, "camera.shadow_bias", {0, 10, "texels"},
            "How far a point is moved along its normal before it is looked up in a shadow map: too little, and "
            "surfaces shade themselves in stripes; too much, and shadows come off what casts them.",
            Gather),
    SETTING(camera.gpu.pcf, "camera.pcf", {1, 5, "taps", /*logarithmic=*/false, /*step=*/2},
            "Samples per axis of light.shadow_filter=pcf and vsm: more widen the shadows' soft edges.", Gather),
    SETTING(camera.gpu.specularDirect, "camera.specular_direct",
            "Highlights of suns, points and spots on surfaces that are not Lambertian.", Shade),
    SETTING(view.shape, "view.shape",
            "How a volume is shown: cubes where it is solid, a slice, a projection along the line of sight (distances: "
            "the sum of their inverses; errors: the largest; else the mean), the surface at a distance; auto: as suits "
            "the view.",
            Nothing),
    SETTING(view.axis, "view.axis", "Axis across the slice; auto: the one that the camera looks along most.", Nothing),
    SETTING(view.slice, "view.slice", {0, 1}, "Place of the slice along its axis, as a share of the grid.", Nothing),
    SETTING(view.isovalue, "view.isovalue", {0, 64, "voxels"},
            "Distance at which fields are shown as cubes or isosurface.", Nothing),
    SETTING(view.jfaPass, "view.jfa_pass", {0, 11},
            "Jump-flood pass after which its seeds are shown; 0: before the first, more than there are: the last.",
            Nothing),
    SETTING(view.light, "view.light", {0, 4096}, "Light of the shadow views, by index.", Nothing),
    SETTING(view.facet, "view.facet", {0, 2147483647},
            "Facet whose row the view matrix-row shows, by index; in the window the one in the inspector.", Nothing),
    SETTING(view.range, "view.range",
            "Values that the colour map's ends stand for. standard: the view's own, auto where it has none; auto: the "
            "picture's smallest and largest.",
            Nothing),
    SETTING(view.low, "view.low", {-1e6, 1e6}, "Lower end of the manual range.", Nothing),
    SETTING(view.high, "view.high", {-1e6, 1e6},
            "Upper end of the manual range; signed views take the larger magnitude to both sides.", Nothing),
    SETTING(view.percentile, "view.percentile", {50, 100, "%"},
            "Upper end of the percentile range; the lower is 100 less this.", Nothing),
    SETTING(view.colorMap, "view.color_map",
            "Colours of scalar views, even in lightness; signed views are always blue-red.", Nothing),
    SETTING(thesis.literal, "thesis.literal",
            "Bring back the thesis's slips (a grid without padding, the sign of 0), to show what they cost.", Voxels),
    SETTING(effects.emission, "effects.emission",
            "Emissive surfaces: the light that they give, and how they look; auto: where a material emits.", Materials),
    SETTING(effects.sun, "effects.sun", "Suns with their shadow maps; auto: those that give light.", Gather),
    SETTING(effects.point, "effects.point",
            "Point lights with their shadow maps; auto: those that give light and whose range reaches the scene.",
            Gather),
    SETTING(effects.spot, "effects.spot",
            "Spot lights with their shadow maps; auto: those that give light and whose range and cone reach the scene.",
            Gather),
    SETTING(
        effects.sky, "effects.sky",
        "The sky: its light, in reflections and behind the scene; auto: where there is one. On keeps what a sky needs "
        "beside the matrix, off leaves the sky out.",
        Matrix),
    SETTING(effects.matrix, "effects.matrix",
            "Indirect light: matrix and solver, or brute force; auto: where there is light, and something that "
            "reflects it.",
            Matrix),
    SETTING(effects.specular, "effects.specular",
            "Reflections; auto: where there is light, and a material that is not Lambertian.", Shade),
    SETTING(effects.writeback, "effects.writeback",
            "Writeback of reflections; auto: where writeback.mode is not off and there are reflections.", Shade),
    SETTING(effects.field, "effects.field", "Distance field kept beside the voxels; auto: where rays read it.", Shade),
    SETTING(effects.relight, "effects.relight",
            "Gather, solve and scatter; auto: until the error bound is below solver.tolerance; on: in every frame of "
            "the window; off: the light stays as it is.",
            Nothing),
    SETTING(effects.glass, "effects.glass",
            "Blended surfaces cover the share alpha of what meets them; panes tint what passes; auto: where a material "
            "has alpha below 1 or transmits light and matrix.hit_rule = triangles. off: opaque; textured ones cut out "
            "at one half.",
            Voxels),
    SETTING(effects.alphaTest, "effects.alpha_test", "Cut-outs by alpha; auto: where a material has one.", Voxels),
    SETTING(effects.normalMap, "effects.normal_map", "Normal maps; auto: where a material has one.", Materials),
    SETTING(effects.blur, "effects.blur",
            "Blur of sample.filter=blur; off: as sample.filter=linear; auto: where it may change H by more than "
            "effects.blur_noise.",
            Scatter),
    SETTING(effects.blurNoise, "effects.blur_noise", {0, 1},
            "The blur is left out where it could change H by less than this share of the largest H.", Scatter),
    SETTING(rasterizer, "device.rasterizer",
            "Who rasterizes voxels (voxel.method=raster), shadow maps and pictures: the graphics pipeline or compute "
            "kernels; auto: kernels where few of the GPU's processors serve the graphics pipeline.",
            Voxels),
    SETTING(scene.lambertian, "scene.lambertian", "Every material Lambertian with its base colour (read at load).",
            Voxels),
    SETTING(scene.doubleSided, "scene.double_sided",
            "Every material double-sided, as path tracers without culling have them (read at load).", Voxels),
    SETTING(scene.region.mode, "scene.region",
            "The part of the scene that has voxels. auto: a small part that holds the detail, if there is one, else "
            "all; whole: "
            "all of it; box: that between scene.region_x0 and so on, also given as scene.region=x0,y0,z0,x1,y1,z1: "
            "what lies outside is lit directly and gives light, but passes none on.",
            Voxels),
    SETTING(scene.region.x0, "scene.region_x0", {-kFarthest, kFarthest, "m"},
            "Least x of the box of scene.region, world.", Voxels),
    SETTING(scene.region.y0, "scene.region_y0", {-kFarthest, kFarthest, "m"},
            "Least y of the box of scene.region, world.", Voxels),
    SETTING(scene.region.z0, "scene.region_z0", {-kFarthest, kFarthest, "m"},
            "Least z of the box of scene.region, world.", Voxels),
    SETTING(scene.region.x1, "scene.region_x1", {-kFarthest, kFarthest, "m"},
            "Largest x of the box of scene.region, world.", Voxels),
    SETTING(scene.region.y1, "scene.region_y1", {-kFarthest, kFarthest, "m"},
            "Largest y of the box of scene.region, world.", Voxels),
    SETTING(scene.region.z1, "scene.region_z1", {-kFarthest, kFarthest, "m"},
            "Largest z of the box of scene.region, world.", Voxels),
};
}  // namespace rows

#undef SETTING

struct Words {
  std::string_view name;
  const char* text;
};
constexpr Words kLabels[] = {{"solver.lambda", "light gain \u03BB"}, {"solver.omega", "relaxation \u03C9"},
                             {"solver.flush", "dark below"},         {"writeback.alpha", "distance power \u03B1"},
                             {"writeback.k", "centre weight k"},     {"writeback.threshold", "least score \u03C4"},
                             {"light.points", "soft shadow points"}, {"camera.pcf", "shadow edge taps"},
                             {"view.jfa_pass", "jump-flood pass"},   {"thesis.literal", "thesis's slips"}};
constexpr Words kGroups[] = {
    {"voxel", "How finely surfaces are cut into voxels, and how"},
    {"field", "The distance field that lets rays skip empty space"},
    {"matrix", "Rays between facets: how many, what they meet, how the form factors are kept"},
    {"solver", "How indirect light is solved from the form factors, and how exactly"},
    {"scatter", "How solved light is put into the volume that shading samples"},
    {"sample", "How a pixel looks up the light of the facets around it"},
    {"specular", "Reflections by rays of each pixel"},
    {"writeback", "Reflections that light the scene in turn"},
    {"light", "Shadows of suns, points and spots"},
    {"sky", "Light from outside the scene"},
    {"camera", "How light becomes the picture that is shown"},
    {"view", "What the views of data show, and in which colours"},
    {"thesis", "What the thesis does that is mended here"},
    {"effects", "Parts of the method: as the scene calls for, always, or never (the panel Effects says why)"},
    {"device", "How the graphics device is used"},
    {"scene", "How the scene's file is read, and which part of it has voxels"}};

}  // namespace

std::string settingLabel(std::string_view name) {
  const auto* const own = std::ranges::find(kLabels, name, &Words::name);
  if (own != std::end(kLabels)) return own->text;
  std::string text(name.substr(name.find('.') + 1));
  std::ranges::replace(text, '_', ' ');
  return text;
}

std::string_view settingGroupHelp(std::string_view group) {
  const auto* const own = std::ranges::find(kGroups, group, &Words::name);
  return own != std::end(kGroups) ? own->text : std::string_view();
}

std::span<const Setting> settingTable() {
  return rows::kTable;
}

}  // namespace irad
