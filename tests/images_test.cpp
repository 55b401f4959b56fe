// Pictures of the built-in scenes and of Sponza against those of tests/golden, which a person has looked at. After a
// change that is meant:
//
//   IRAD_BLESS=1 ctest --test-dir build -C suite -R '^images$'
//
// Then look at them (git difftool, or any viewer of EXR).
// Where a picture differs, NAME.ours.png, NAME.golden.png and NAME.difference.png (4 times |ours - golden|) lie
// together in build/test-results/images.
#include <gtest/gtest.h>

#if IRAD_OIIO

#include <cstdlib>
#include <span>

#include "gi/pipeline.h"
#include "renderer/base/image_io.h"
#include "renderer/base/output_file.h"
#include "renderer/scene/scene.h"
#include "renderer/targets.h"
#include "tests/exr.h"
#include "tests/support.h"

namespace irad::test::images_suite {
namespace {

constexpr uint32_t kSide = 96;  ///< pixels

/// How far a picture may be from its golden one. The same driver gives the same bits, to the golden file's half floats
/// (5e-4); the rest is room for another driver's rasterizer and filters, which move single pixels along edges, and is
/// less than another seed of the rays makes (AChangedSettingIsSeen).
struct Tolerance {
  double rmse;        ///< over the golden picture's root mean square
  double relMse;      ///< epsilon kRelMseEpsilon
  double worstPixel;  ///< largest |difference| of a channel, over the golden picture's largest value
};
constexpr Tolerance kTolerance{.rmse = 0.01, .relMse = 5e-4, .worstPixel = 0.15};

struct Difference {
  double rmse, relMse, worstPixel;
  bool within(const Tolerance& t) const {
    return rmse <= t.rmse && relMse <= t.relMse && worstPixel <= t.worstPixel;  // false where any is NaN
  }
  std::string text() const {
    return fmt::format("RMSE {:.5f} of the root mean square, relMSE (eps {}) {:.3g}, worst pixel {:.4f} of the largest",
                       rmse, kRelMseEpsilon, relMse, worstPixel);
  }
};

Difference compare(const ExrPicture& ours, const ExrPicture& golden) {
  const ExrPicture black{golden.width, golden.height, std::vector<glm::vec3>(golden.pixels.size(), glm::vec3(0))};
  const Metrics difference = metrics(ours, golden), whole = metrics(golden, black);
  return {difference.rmse / whole.rmse, difference.relMse, difference.largest / whole.largest};
}

std::filesystem::path goldenPath(const std::string& name) {
  return sourceFolder() / "tests/golden" / (name + ".exr");
}

void writeHalf(const std::filesystem::path& path, const ExrPicture& picture) {
  makeFolder(path.parent_path());
  OIIO::ImageSpec spec(static_cast<int>(picture.width), static_cast<int>(picture.height), 3, OIIO::TypeDesc::HALF);
  spec.attribute("compression", "zip");
  spec.attribute("DateTime", "    :  :     :  :  ");  // Exif's "unknown": the same picture is the same file
  const auto out = OIIO::ImageOutput::create(path.string());
  ASSERT_TRUE(out && out->open(path.string(), spec) && out->write_image(OIIO::TypeDesc::FLOAT, picture.pixels.data()) &&
              out->close())
      << path << ": " << OIIO::geterror();
}

/// For the eye: clamped, gamma 2.2; normals from -1..1.
void writeShown(const std::filesystem::path& stem, const ExrPicture& picture, bool normals) {
  std::vector<glm::u8vec4> bytes;
  for (const glm::vec3& p : picture.pixels) {
    const glm::vec3 shown = normals ? 0.5f + 0.5f * p : glm::pow(glm::clamp(p, 0.0f, 1.0f), glm::vec3(1 / 2.2f));
    bytes.emplace_back(glm::u8vec3(glm::clamp(shown, 0.0f, 1.0f) * 255.0f + 0.5f), 255);
  }
  writeDisplay(stem, {picture.width, picture.height}, bytes);
}

/// A scene under fixed settings, small enough for a CPU rasterizer.
class Pictures {
 public:
  Pictures(Context& context, const std::filesystem::path& scene)
      : context_(context), pipeline_(context, loadScene(scene), settings()), targets_(context, {kSide, kSide}) {
    prepare();
  }
  /// Settings other than this one.
  void set(const std::function<void(Settings&)>& change) {
    Settings s = settings();
    change(s);
    pipeline_.set(s);
    prepare();
  }
  const Scene& scene() const { return pipeline_.scene(); }
  ExrPicture draw(const char* view, size_t camera) {
    Frame frame = context_.begin();
    pipeline_.render(frame, scene().cameras.at(camera), findView(view).value(), targets_, {.shareSurfaces = true});
    frame.submitAndWait();
    const std::vector<std::byte> bytes = download(context_, targets_.linear);
    ExrPicture picture{kSide, kSide, std::vector<glm::vec3>(size_t{kSide} * kSide)};
    for (size_t i = 0; i < picture.pixels.size(); ++i)
      std::memcpy(&picture.pixels[i], &bytes[i * sizeof(glm::vec4)], sizeof(glm::vec3));
    return picture;
  }

 private:
  void prepare() {
    pipeline_.prepare();
    EXPECT_TRUE(pipeline_.asleep()) << "the solver did not reach its tolerance";
  }
  static Settings settings() {
    Settings s = defaultSettings(/*cpuDevice=*/true);
    s.voxel.resolution = 48;
    s.matrix.gpu.rays = 64;
    s.light.shadowResolution = 1024;
    return s;
  }
  Context& context_;
  Pipeline pipeline_;
  Targets targets_;
};

constexpr const char* kViews[] = {"lit", "no-gi", "indirect", "voxel-normal", "irradiance"};

class GoldenImages : public GpuTest {
 protected:
  static void TearDownTestSuite() { box_.reset(); }
  /// Prepared once for all tests.
  Pictures& box() {
    if (!box_) box_ = std::make_unique<Pictures>(context(), assets() / "box.glb");
    return *box_;
  }
  /// Views of one camera against its golden picture, or makes these.
  void check(Pictures& pictures, size_t camera, const std::string& prefix,
             std::span<const char* const> views = kViews) {
    const char* bless = std::getenv("IRAD_BLESS");
    for (const char* view : views) {
      const std::string name = prefix + "." + view;
      const ExrPicture ours = pictures.draw(view, camera);
      if (bless && *bless == '1') {
        writeHalf(goldenPath(name), ours);
        std::printf("blessed %s\n", goldenPath(name).c_str());
        continue;
      }
      ASSERT_TRUE(std::filesystem::exists(goldenPath(name))) << goldenPath(name) << ": IRAD_BLESS=1 makes it";
      const ExrPicture golden = readExr(goldenPath(name));
      ASSERT_EQ(glm::uvec2(golden.width, golden.height), glm::uvec2(kSide));
      const Difference d = compare(ours, golden);
      std::printf("%-24s %s\n", name.c_str(), d.text().c_str());
      if (d.within(kTolerance)) continue;
      ADD_FAILURE() << name << " is not its golden picture: " << d.text() << "; see " << leave(name, ours, golden);
    }
  }

 private:
  /// Ours, golden and difference beside one another; their folder.
  static std::filesystem::path leave(const std::string& name, const ExrPicture& ours, const ExrPicture& golden) {
    const std::filesystem::path folder = buildFolder() / "test-results/images";
    makeFolder(folder);
    ExrPicture difference = ours;
    for (size_t i = 0; i < ours.pixels.size(); ++i)
      difference.pixels[i] = 4.0f * glm::abs(ours.pixels[i] - golden.pixels[i]);
    const bool normals = name.ends_with("normal");
    writeShown(folder / (name + ".ours"), ours, normals);
    writeShown(folder / (name + ".golden"), golden, normals);
    writeShown(folder / (name + ".difference"), difference, /*normals=*/false);
    return folder;
  }

  static inline std::unique_ptr<Pictures> box_;
};

TEST_F(GoldenImages, BoxFromBothCameras) {
  Pictures& box = this->box();
  ASSERT_EQ(box.scene().cameras.size(), 2u);
  for (size_t camera = 0; camera < 2; ++camera) check(box, camera, "box." + box.scene().cameras[camera].name);
}

TEST_F(GoldenImages, FurtherBuiltInScenes) {
  constexpr const char* kLit[] = {"lit"};
  for (const char* name : {"park", "arena", "box-hard"}) {
    Pictures pictures(context(), assets() / (std::string(name) + ".glb"));
    const std::vector<Camera>& cameras = pictures.scene().cameras;
    for (size_t camera = 0; camera < cameras.size(); ++camera)
      check(pictures, camera, std::string(name) + "." + cameras[camera].name, kLit);
  }
}

TEST_F(GoldenImages, OnlyIndirectLightReachesIntoTheArenasCaves) {
  Pictures arena(context(), assets() / "arena.glb");
  ASSERT_EQ(arena.scene().cameras.at(1).name, "cave");
  const ExrPicture direct = arena.draw("no-gi", 1), lit = arena.draw("lit", 1);
  // The upper fifth is the ceiling of the hall.
  for (size_t i = 0; i < size_t{kSide} * (kSide / 5); ++i) {
    EXPECT_EQ(direct.pixels[i], glm::vec3(0)) << i;
    EXPECT_GT(lit.pixels[i].x, 0) << i;
  }
}

TEST_F(GoldenImages, Sponza) {
  const auto shared = sharedScenes();
  if (!shared) GTEST_SKIP() << "../shared/scenes is absent: no pictures of Sponza";
  Pictures sponza(context(), *shared / "sponza/sponza_small_lit_m.glb");
  check(sponza, 0, "sponza");
}

TEST_F(GoldenImages, TheWholeWayTwiceGivesTheSameBits) {
  std::vector<ExrPicture> first;
  for (const char* view : kViews) first.push_back(box().draw(view, 1));
  Pictures again(context(), assets() / "box.glb");
  for (size_t v = 0; v < std::size(kViews); ++v) {
    const ExrPicture picture = again.draw(kViews[v], 1);
    EXPECT_EQ(std::memcmp(picture.pixels.data(), first[v].pixels.data(), picture.pixels.size() * sizeof(glm::vec3)), 0)
        << kViews[v];
  }
}

TEST_F(GoldenImages, AChangedSettingIsSeen) {
  // The comparison would tell each of these from the golden picture, by the view that shows it.
  struct Case {
    const char* what;
    const char* view;
    void (*change)(Settings&);
  };
  Pictures changed(context(), assets() / "box.glb");
  for (const Case& c :
       {Case{"another seed", "irradiance", [](Settings& s) { s.matrix.gpu.seed += 1; }},
        Case{"another resolution", "voxel-normal", [](Settings& s) { s.voxel.resolution = 47; }},
        Case{"coarse normals", "voxel-normal", [](Settings& s) { s.voxel.normals = NormalEncoding::axis26; }},
        Case{"unfiltered light", "indirect", [](Settings& s) { s.sample.gpu.filter_ = FILTER_NEAREST; }},
        Case{"no reflections", "lit", [](Settings& s) { s.specular.mode = SpecularMode::off; }}}) {
    changed.set(c.change);
    const Difference d = compare(changed.draw(c.view, 0), box().draw(c.view, 0));
    std::printf("%-24s %s\n", c.what, d.text().c_str());
    EXPECT_FALSE(d.within(kTolerance)) << c.what << " passes for the same picture: " << d.text();
  }
}

}  // namespace
}  // namespace irad::test::images_suite

#else

TEST(GoldenImages, NotBuilt) {
  GTEST_SKIP() << "built without IRAD_OIIO";
}

#endif
