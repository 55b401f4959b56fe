// What is kept against a crash: its file, whole or not at all, whose it is, and what is said of it.
#include <gtest/gtest.h>

#if IRAD_UI

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "renderer/base/error.h"
#include "tests/support.h"
#include "ui/autosave.h"

namespace irad::test::autosave_suite {
namespace {

Autosave example() {
  Autosave a{.scene = "/scenes/a \"b\".glb", .time = 1'700'000'000};
  a.edits.lights = {{.name = "lamp", .type = LightType::Point, .position = {0.1, 2, 1e-30}, .intensity = 0.3f}};
  a.edits.materials = {{.material = "wall", .baseColor = glm::vec3(0.1f, 0.2f, 0.3f), .texturesOff = 1}};
  a.edits.hidden = {{"hall/table", "lamp"}, "hall"};
  a.edits.bookmarks = {{.name = "door", .position = {1, 2, 3.3}}};
  a.edits.sceneSha256 = "abc";
  a.sky = "/skies/evening.hdr";
  a.reference = "/truth.exr";
  a.settings.matrix.gpu.rays = 77;
  a.settings.solver.tolerance = 0.1f;
  a.other = a.settings;
  a.other->sample.emitterRays = 3;
  a.view = VIEW_DIRECT;
  a.camera = {.name = "main", .position = {0.1, 0.2, 0.3}, .yfov = 0.7f};
  return a;
}

size_t filesIn(const std::filesystem::path& folder) {
  return static_cast<size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(Autosave, ComesBackToTheSameBits) {
  const TemporaryFolder folder;
  const auto file = folder.path / "not/yet/there/1.json";
  for (Autosave a : {example(), Autosave{.scene = "check:furnace-inner"}}) {
    writeAutosave(file, a);
    EXPECT_EQ(readAutosave(file), a);
  }
}

TEST(Autosave, BadFilesAreNamed) {
  const TemporaryFolder folder;
  const auto file = folder.path / "1.json";
  writeAutosave(file, example());
  const std::string good = slurp(file);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const size_t at = text.find(from);
    EXPECT_NE(at, text.npos) << from;
    return text.replace(at, from.size(), to);
  };
  const std::pair<std::string, const char*> bad[] = {
      {with("\"format\": 1", "\"format\": 2"), "format"},
      {with("\"direct\"", "\"no-view\""), "no-view"},
      {with("1700000000", "\"now\""), "time"},
      {with("\"matrix.rays\": 77", "\"matrix.rays\": -1"), "matrix.rays"},
      {with("\"matrix.rays\": 77", "\"matrix.raise\": 77"), "matrix.raise"},
      {with("\"point\"", "\"pint\""), "pint"},
      {good.substr(0, good.size() / 2), "not JSON"},
      {"[]", "format"},
      {"", "not JSON"},
  };
  for (const auto& [text, part] : bad) {
    std::ofstream(file) << text;
    try {
      readAutosave(file);
      ADD_FAILURE() << part << " was read";
    } catch (const InputError& error) {
      EXPECT_TRUE(contains(error.what(), file.string())) << error.what();
      EXPECT_TRUE(contains(error.what(), part)) << error.what();
    }
  }
}

TEST(Autosave, SaysWhatItHolds) {
  Autosave a = example();
  a.other.reset();
  EXPECT_EQ(contentInWords(a, Settings()),
            (std::vector<std::string>{"1 light: lamp", "1 material: wall", "isolated: hall",
                                      "2 hidden objects: hall/table, lamp", "1 bookmark: door",
                                      "picture of the sky: evening.hdr", "reference: truth.exr",
                                      "settings: matrix.rays 77, solver.tolerance 0.1"}));
  a.edits.bookmarks.clear();
  a.edits.materials.clear();
  a.edits.hidden = {};
  a.sky = a.reference = {};
  a.edits.lights->resize(7, {.name = "sun"});
  EXPECT_EQ(contentInWords(a, a.settings), (std::vector<std::string>{"7 lights: lamp, sun, sun, sun, sun and 2 more"}));
  EXPECT_EQ(contentInWords({}, Settings()).size(), 1u);
  setenv("TZ", "UTC", 1);
  tzset();
  EXPECT_EQ(timeInWords(1'700'000'000), "14 Nov 2023, 22:13");
  EXPECT_EQ(timeInWords(1'701'400'000), "1 Dec 2023, 03:06");
  unsetenv("TZ");
  tzset();
}

TEST(Autosave, IsFoundOnceItsWindowHasGone) {
  const TemporaryFolder temporary;
  const auto folder = temporary.path / "autosave";
  Autosave first = example(), second = example();
  second.scene = "/scenes/second.glb";
  Autosaves later(folder);
  EXPECT_FALSE(later.find()) << "no folder";
  {
    Autosaves living(folder);
    EXPECT_FALSE(living.keeps());
    living.keep(first);
    living.keep(second);
    EXPECT_FALSE(later.find()) << "that of a window that runs";
    EXPECT_FALSE(living.find()) << "its own";
    Autosaves other(folder);
    other.keep(first);
    EXPECT_EQ(filesIn(folder), 4u) << "a file and a lock each";
    other.removeKept();
    EXPECT_EQ(filesIn(folder), 2u);
  }
  EXPECT_EQ(later.find(), second);
  {
    Autosaves third(folder);
    EXPECT_FALSE(third.find()) << "another start offers it";
    later.leaveFound();
    EXPECT_EQ(third.find(), second);
  }
  EXPECT_FALSE(later.find()) << "asked twice";
  Autosaves again(folder);
  EXPECT_EQ(again.find(), second);
  again.removeFound();
  EXPECT_EQ(filesIn(folder), 0u);
  EXPECT_FALSE(Autosaves(folder).find());
  // No folder at all, and one that cannot be made.
  Autosaves nowhere{std::filesystem::path()};
  nowhere.keep(first);
  EXPECT_FALSE(nowhere.find());
  std::ofstream(temporary.path / "taken") << "a file";
  EXPECT_THROW(Autosaves(temporary.path / "taken/autosave").keep(first), WorkError);
}

TEST(Autosave, OneThatCannotBeReadStaysAndTheNextIsFound) {
  const TemporaryFolder folder;
  Autosaves(folder.path).keep(example());
  std::ofstream(folder.path / "0.1.json") << "{";
  std::filesystem::last_write_time(folder.path / "0.1.json",
                                   std::filesystem::file_time_type::clock::now() + std::chrono::seconds(5));
  Autosaves later(folder.path);
  EXPECT_THROW((void)later.find(), InputError);
  EXPECT_EQ(later.find(), example());
  EXPECT_TRUE(std::filesystem::exists(folder.path / "0.1.json"));
}

/// A process is killed again and again while it writes one of two contents over the other.
TEST(Autosave, AndSidecarAreWholeWheneverTheWriterIsKilled) {
  const TemporaryFolder folder;
  const auto autosave = folder.path / "1.json", sidecar = folder.path / "a.glb.irad.json";
  Autosave small = example(), large = example();
  large.edits.lights->resize(300, large.edits.lights->front());
  writeAutosave(autosave, small);
  writeSidecar(sidecar, small.edits);
  // Twelve times, and until both contents have been met: a slow disk takes longer for a file than the writer lives.
  bool metSmall = false, metLarge = false;
  for (int i = 0; i < 12 || ((!metSmall || !metLarge) && i < 300); ++i) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0)
      for (int n = 0;; ++n) {
        writeAutosave(autosave, n % 2 == 0 ? large : small);
        writeSidecar(sidecar, n % 2 == 0 ? large.edits : small.edits);
      }
    usleep(static_cast<useconds_t>(15'000 + 3'700 * (i % 40)));
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status)) << "the writer failed";
    const Autosave kept = readAutosave(autosave);
    EXPECT_TRUE(kept == small || kept == large) << i;
    const Sidecar edits = readSidecar(sidecar);
    EXPECT_TRUE(edits == small.edits || edits == large.edits) << i;
    (kept == large ? metLarge : metSmall) = true;
  }
  EXPECT_TRUE(metSmall && metLarge) << "it was never killed in the middle";
}

}  // namespace
}  // namespace irad::test::autosave_suite

#else

TEST(Autosave, NotBuilt) {
  GTEST_SKIP() << "built without IRAD_UI";
}

#endif
