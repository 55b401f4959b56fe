// The irad program where its standard streams are closed, full, or pipes that nobody reads any more: whatever it prints
// there, it ends with one of its statuses.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/wait.h>

#include <fstream>

#include "tests/support.h"

namespace irad::streams_suite {
namespace {

using test::contains;
using test::slurp;

enum class Stream { Fine, Closed, Full, Unread };
constexpr Stream kStreams[] = {Stream::Fine, Stream::Closed, Stream::Full, Stream::Unread};
constexpr const char* kNames[] = {"fine", "closed", "full", "unread"};

class Streams : public ::testing::Test {
 protected:
  struct Result {
    int status;  ///< as a shell has it: 134 is an abort
    std::string out, err;
  };
  /// Through a shell: its exit status is the program's, also where the other end of a pipe has gone before it starts.
  Result run(const std::string& arguments, Stream out, Stream err) {
    const std::string outFile = folder_.path / "out", errFile = folder_.path / "err";
    for (const std::string& file : {outFile, errFile}) std::ofstream(file).close();
    const auto redirection = [](Stream stream, int number, const std::string& file) {
      switch (stream) {
        case Stream::Fine:
          return fmt::format("{}>'{}'", number, file);
        case Stream::Closed:
          return fmt::format("{}>&-", number);
        case Stream::Full:
          return fmt::format("{}>/dev/full", number);
        case Stream::Unread:
          return fmt::format("{}>&9", number);
      }
      return std::string();
    };
    // 9 becomes a pipe whose reader has gone: a fifo opened for reading and writing, then for writing, then the first
    // closed again.
    const std::string script =
        fmt::format("cd '{0}' && rm -f fifo && mkfifo fifo && exec 8<>fifo 9>fifo 8>&- && exec '{1}' {2} {3} {4}",
                    folder_.path.string(), test::iradProgram(), arguments, redirection(out, 1, outFile),
                    redirection(err, 2, errFile));
    std::ofstream(folder_.path / "script") << script << "\n";
    const int status = std::system(fmt::format("sh '{}'", (folder_.path / "script").string()).c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), slurp(outFile), slurp(errFile)};
  }
  /// `status` while results can be written, else 1 where there are any: as for every combination of streams.
  void expect(const std::string& arguments, int status, bool results, Stream out, Stream err) {
    const Result result = run(arguments, out, err);
    const bool lost = results && out != Stream::Fine;
    const std::string where = fmt::format("irad {}, standard output {}, standard error {}\n{}", arguments,
                                          kNames[static_cast<int>(out)], kNames[static_cast<int>(err)], result.err);
    EXPECT_EQ(result.status, lost ? 1 : status) << where;
    if (results && out == Stream::Fine) {
      EXPECT_FALSE(result.out.empty()) << where;
    }
    if (err != Stream::Fine) return;
    EXPECT_EQ(contains(result.err, "cannot write to standard output"), lost) << where;
    EXPECT_EQ(contains(result.err, "irad: error: "), lost || status != 0) << where;
  }

  test::TemporaryFolder folder_;
};

TEST_F(Streams, OfEveryKindEndWithAStatus) {
  for (const Stream out : kStreams)
    for (const Stream err : kStreams) {
      expect("--version", 0, /*results=*/true, out, err);
      expect("rendr", 2, /*results=*/false, out, err);
    }
}

TEST_F(Streams, OfEverySubcommandEndWithAStatus) {
  for (const char* arguments : {"--help", "render --help", "settings", "settings --json", "views", "--list-devices"}) {
    expect(arguments, 0, /*results=*/true, Stream::Fine, Stream::Closed);
    expect(arguments, 0, /*results=*/true, Stream::Full, Stream::Fine);
    expect(arguments, 0, /*results=*/true, Stream::Closed, Stream::Closed);
  }
  for (const char* arguments : {"render absent.glb", "export absent.glb --volume albedo", "plan absent.glb"})
    for (const Stream err : {Stream::Closed, Stream::Full}) expect(arguments, 3, false, Stream::Fine, err);
}

TEST_F(Streams, WorkWithProgressGoesOn) {
  const std::string small = "--set voxel.resolution=8 --set matrix.rays=4 --set specular.mode=off";
  for (const Stream err : {Stream::Closed, Stream::Full, Stream::Unread}) {
    expect("plan box " + small, 0, /*results=*/true, Stream::Fine, err);
    const std::string render = fmt::format("{}", fmt::join(test::quickRender("pictures"), " "));
    expect(render, 0, /*results=*/true, Stream::Fine, err);
    EXPECT_TRUE(std::filesystem::exists(folder_.path / "pictures/manifest.json"));
    std::filesystem::remove_all(folder_.path / "pictures");
  }
  // Results that have no place: what is saved is saved.
  expect(fmt::format("{}", fmt::join(test::quickRender("pictures"), " ")), 0, true, Stream::Full, Stream::Closed);
  EXPECT_TRUE(std::filesystem::exists(folder_.path / "pictures/manifest.json"));
}

/// A closed stream leaves its number free: messages must not end up in the next file that is opened.
TEST_F(Streams, ThatAreClosedAreNoFilesOfTheWork) {
  const std::string render = fmt::format("{}", fmt::join(test::quickRender("pictures"), " "));
  expect(render, 0, true, Stream::Fine, Stream::Fine);
  auto wanted = test::contents(folder_.path / "pictures");
  std::filesystem::remove_all(folder_.path / "pictures");
  expect(render + " <&-", 0, true, Stream::Closed, Stream::Closed);
  auto found = test::contents(folder_.path / "pictures");
  ASSERT_EQ(found.size(), wanted.size());
  for (const auto& [name, bytes] : wanted) {
    if (name.ends_with(".exr") || name.ends_with(".png")) {
      EXPECT_EQ(found[name], bytes) << name;
    }
    EXPECT_FALSE(contains(found[name], "irad: error")) << name;
  }
}

}  // namespace
}  // namespace irad::streams_suite
