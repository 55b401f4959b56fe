// Output files: whole or not at all, and readable by others.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>

#include "gi/picture.h"
#include "renderer/base/error.h"
#include "renderer/base/image_io.h"
#include "renderer/base/output_file.h"
#include "tests/support.h"

#ifdef IRAD_OIIO
#include <OpenImageIO/imageio.h>
#endif

namespace irad::output_suite {
namespace {

namespace fs = std::filesystem;
using test::contains;
using test::slurp;

std::vector<std::string> listing(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string workError(const std::function<void()>& act) {
  try {
    act();
  } catch (const WorkError& error) {
    EXPECT_EQ(error.exitStatus, 1);
    return error.what();
  }
  return "(no error)";
}

/// Lets no file of this process grow beyond `bytes`: what a full disk looks like, for root too.
struct FileSizeLimit {
  explicit FileSizeLimit(rlim_t bytes) {
    handler = std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before);
    const rlimit limit{bytes, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
  }
  rlimit before{};
  void (*handler)(int);
};

TEST(OutputFile, AppearsOnlyWhenComplete) {
  test::TemporaryFolder folder;
  const fs::path path = folder.path / "a.txt";
  writeFile(path, "old");
  {
    OutputFile file(path);
    file.write("new");
    EXPECT_EQ(slurp(path), "old");
  }  // dropped without commit
  EXPECT_EQ(slurp(path), "old");
  EXPECT_EQ(listing(folder.path), std::vector<std::string>{"a.txt"});
  writeFile(path, "new");
  EXPECT_EQ(slurp(path), "new");
  EXPECT_EQ(listing(folder.path), std::vector<std::string>{"a.txt"});
}

TEST(OutputFile, AFileInPlaceOfAFolderIsNamed) {
  test::TemporaryFolder folder;
  writeFile(folder.path / "plain", "x");
  const std::string message = workError([&] { writeFile(folder.path / "plain" / "a.txt", "x"); });
  EXPECT_TRUE(contains(message, (folder.path / "plain" / "a.txt").string())) << message;
  EXPECT_TRUE(contains(message, "Not a directory")) << message;
  EXPECT_TRUE(contains(workError([&] { makeFolder(folder.path / "plain"); }), "plain"));
  EXPECT_TRUE(contains(workError([&] { makeFolder(folder.path / "plain" / "sub"); }), "plain"));
  EXPECT_TRUE(contains(workError([&] { writeFile(folder.path / "absent" / "a", "x"); }), "No such file"));
}

TEST(OutputFile, AFolderInPlaceOfTheFileStays) {
  test::TemporaryFolder folder;
  fs::create_directory(folder.path / "out.csv");
  EXPECT_TRUE(contains(workError([&] { writeFile(folder.path / "out.csv", "x"); }), "out.csv"));
  EXPECT_EQ(listing(folder.path), std::vector<std::string>{"out.csv"});
}

TEST(OutputFile, AFullDiskLeavesNothingAndKeepsTheOldFile) {
  test::TemporaryFolder folder;
  const fs::path path = folder.path / "big.bin";
  writeFile(path, "old");
  std::string message;
  {
    FileSizeLimit limit(4096);
    message = workError([&] { writeFile(path, std::string(100'000, 'x')); });
    // Small writes fail late, when the buffer is flushed.
    EXPECT_NE(workError([&] { writeFile(path, std::string(4200, 'x')); }), "(no error)");
  }
  EXPECT_TRUE(contains(message, path.string())) << message;
  EXPECT_EQ(slurp(path), "old");
  EXPECT_EQ(listing(folder.path), std::vector<std::string>{"big.bin"});
}

TEST(OutputFile, WhatAKilledRunLeavesGoesWithTheNextFile) {
  test::TemporaryFolder folder;
  const fs::path path = folder.path / "a.txt";
  writeFile(path, "old");
  const pid_t child = fork();
  if (child == 0) {
    OutputFile file(path);
    file.write(std::string(100'000, 'x'));
    kill(getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
  const std::string leftover = fmt::format(".a.txt.{}.irad-tmp", child);
  EXPECT_EQ(listing(folder.path), (std::vector<std::string>{leftover, "a.txt"}));
  EXPECT_EQ(slurp(path), "old");

  // What this run is still writing stays, and so does whatever else has a dot before its name.
  writeFile(folder.path / ".hidden.irad", "x");
  fs::create_directory(folder.path / ".hidden");
  OutputFile open(folder.path / "c.txt");
  EXPECT_FALSE(fs::exists(folder.path / leftover));
  OutputFolder group(folder.path / "group");
  writeFile(folder.path / "b.txt", "b");
  open.write("c");
  open.commit();
  group.commit();
  EXPECT_EQ(listing(folder.path),
            (std::vector<std::string>{".hidden", ".hidden.irad", "a.txt", "b.txt", "c.txt", "group.001"}));
}

TEST(OutputFolder, AppearsOnlyWhenCompleteUnderTheFirstFreeNumber) {
  test::TemporaryFolder folder;
  const fs::path parent = folder.path / "deep" / "er";
  {
    OutputFolder dropped(parent / "box");
    writeFile(dropped.temporary() / "a.txt", "a");
  }
  EXPECT_TRUE(listing(parent).empty());
  // A number that is taken, by a folder or by a file, stays what it is.
  writeFile(parent / "box.001", "a file");
  fs::create_directory(parent / "box.002");
  writeFile(parent / "box.002" / "old.txt", "old");
  for (const char* name : {"box.003", "box.004"}) {
    OutputFolder group(parent / "box");
    writeFile(group.temporary() / "a.txt", "a");
    EXPECT_FALSE(fs::exists(parent / name));
    EXPECT_EQ(group.commit(), parent / name);
    EXPECT_EQ(listing(parent / name), std::vector<std::string>{"a.txt"});
  }
  EXPECT_EQ(slurp(parent / "box.001"), "a file");
  EXPECT_EQ(listing(parent / "box.002"), std::vector<std::string>{"old.txt"});
}

TEST(OutputFolder, WhatCannotBeMadeIsNamedAndAKilledRunsIsRemoved) {
  test::TemporaryFolder folder;
  writeFile(folder.path / "plain", "x");
  EXPECT_TRUE(contains(workError([&] { OutputFolder(folder.path / "plain" / "box"); }), "plain"));
  EXPECT_EQ(listing(folder.path), std::vector<std::string>{"plain"});
  const pid_t child = fork();
  if (child == 0) {
    OutputFolder group(folder.path / "box");
    writeFile(group.temporary() / "a.txt", "a");
    kill(getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(fs::exists(folder.path / fmt::format(".box.{}.irad-tmp", child) / "a.txt"));
  OutputFolder(folder.path / "box").commit();
  EXPECT_EQ(listing(folder.path), (std::vector<std::string>{"box.001", "plain"}));
}

TEST(Npy, HeaderByHand) {
  test::TemporaryFolder folder;
  const std::vector<float> values{1, 2, 3, 4, 5, 6};
  writeNpy<float>(folder.path / "a.npy", {2, 3}, values);
  const std::string bytes = slurp(folder.path / "a.npy");
  EXPECT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  const size_t length = static_cast<uint8_t>(bytes[8]) + 256u * static_cast<uint8_t>(bytes[9]);
  EXPECT_EQ((10 + length) % 64, 0u);
  const std::string header = bytes.substr(10, length);
  EXPECT_EQ(header.substr(0, header.find('}') + 1), "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }");
  EXPECT_EQ(header.back(), '\n');
  ASSERT_EQ(bytes.size(), 10 + length + sizeof(float) * values.size());
  EXPECT_EQ(std::memcmp(bytes.data() + 10 + length, values.data(), sizeof(float) * values.size()), 0);
  writeNpy<int64_t>(folder.path / "b.npy", {4}, std::vector<int64_t>{0, 1, 2, 1ll << 40});
  EXPECT_TRUE(contains(slurp(folder.path / "b.npy"), "'<i8', 'fortran_order': False, 'shape': (4,), }"));
}

TEST(Npy, NumpyReadsIt) {
  if (std::system("/usr/bin/python3 -c 'import numpy' 2>/dev/null") != 0) GTEST_SKIP() << "python3-numpy is not here";
  test::TemporaryFolder folder;
  std::vector<float> values(2 * 3 * 4 * 3);
  for (size_t i = 0; i < values.size(); ++i) values[i] = 0.5f * static_cast<float>(i);
  writeNpy<float>(folder.path / "f.npy", {2, 3, 4, 3}, values);
  writeNpy<int32_t>(folder.path / "i.npy", {3}, std::vector<int32_t>{-1, 0, 7});
  writeNpy<int64_t>(folder.path / "l.npy", {1}, std::vector<int64_t>{1ll << 40});
  writeNpy<uint8_t>(folder.path / "u.npy", {1, 1, 3}, std::vector<uint8_t>{0, 127, 255});
  writeNpy<float>(folder.path / "e.npy", {0, 3}, std::vector<float>{});
  const std::string script = fmt::format(
      "/usr/bin/python3 -c \"import numpy as n; d='{}/'; f=n.load(d+'f.npy'); assert f.shape==(2,3,4,3) and "
      "f.dtype==n.float32 and f[1,2,3,1]==35.0, f; assert n.load(d+'i.npy').tolist()==[-1,0,7]; assert "
      "n.load(d+'l.npy')[0]==2**40; assert n.load(d+'u.npy').tolist()==[[[0,127,255]]]; assert "
      "n.load(d+'e.npy').shape==(0,3)\"",
      folder.path.string());
  EXPECT_EQ(std::system(script.c_str()), 0);
}

/// A ramp with values far outside [0, 1] and exact binary fractions.
std::vector<glm::vec4> ramp(glm::uvec2 size) {
  std::vector<glm::vec4> pixels;
  for (uint32_t i = 0; i < size.x * size.y; ++i)
    pixels.emplace_back(1e-6f * static_cast<float>(i), 1e6f - static_cast<float>(i), -0.1f * static_cast<float>(i),
                        1.0f);
  return pixels;
}

TEST(ImageIo, PfmByHand) {
  test::TemporaryFolder folder;
  const glm::uvec2 size(3, 2);
  const std::vector<glm::vec4> pixels = ramp(size);
  writePfm(folder.path / "a.pfm", size, pixels);
  const std::string bytes = slurp(folder.path / "a.pfm");
  const std::string header = "PF\n3 2\n-1.0\n";
  ASSERT_EQ(bytes.substr(0, header.size()), header);
  ASSERT_EQ(bytes.size(), header.size() + 3 * 2 * 3 * sizeof(float));
  float first[3];
  std::memcpy(first, bytes.data() + header.size(), sizeof first);
  EXPECT_EQ(glm::vec3(first[0], first[1], first[2]), glm::vec3(pixels[3]));  // the bottom row comes first
}

#ifdef IRAD_OIIO
TEST(ImageIo, ExrKeepsEveryBitAndPngEveryByte) {
  test::TemporaryFolder folder;
  const glm::uvec2 size(37, 11);
  const std::vector<glm::vec4> pixels = ramp(size);
  const fs::path exr = writeLinear(folder.path / "cam.lit", size, pixels);
  EXPECT_EQ(exr.filename(), "cam.lit.exr");
  const auto in = OIIO::ImageInput::open(exr.string());
  ASSERT_TRUE(in);
  EXPECT_EQ(in->spec().width, 37);
  EXPECT_EQ(in->spec().height, 11);
  EXPECT_EQ(in->spec().channelnames, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(in->spec().format, OIIO::TypeDesc::FLOAT);
  std::vector<glm::vec3> read(pixels.size());
  ASSERT_TRUE(in->read_image(0, 0, 0, 3, OIIO::TypeDesc::FLOAT, read.data()));
  for (size_t i = 0; i < read.size(); ++i) ASSERT_EQ(read[i], glm::vec3(pixels[i])) << i;

  std::vector<glm::u8vec4> bytes;
  for (uint32_t i = 0; i < size.x * size.y; ++i) bytes.emplace_back(i & 255, 255 - (i & 255), 7, 0);
  const fs::path png = writeDisplay(folder.path / "cam.lit", size, bytes);
  EXPECT_EQ(png.filename(), "cam.lit.png");
  const auto inPng = OIIO::ImageInput::open(png.string());
  ASSERT_TRUE(inPng);
  EXPECT_EQ(inPng->spec().nchannels, 3);
  std::vector<glm::u8vec3> readBytes(bytes.size());
  ASSERT_TRUE(inPng->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, readBytes.data()));
  for (size_t i = 0; i < bytes.size(); ++i) ASSERT_EQ(readBytes[i], glm::u8vec3(bytes[i])) << i;
}

TEST(ImageIo, LayersSayWhatTheyShow) {
  test::TemporaryFolder folder;
  const glm::uvec2 size(5, 4);
  const PictureLayer layers[] = {{"", ramp(size)}, {"error", ramp(size)}};
  const std::string camera = R"({"name": "a \"b\"", "position": [0.1, 2, 3]})";
  const LinearPicture with = readLinear(writeLayers(folder.path / "a", size, layers, {camera, "indirect"}).front());
  EXPECT_EQ(with.subject.camera, camera);
  EXPECT_EQ(with.subject.view, "indirect");
  const LinearPicture without = readLinear(writeLayers(folder.path / "b", size, layers).front());
  EXPECT_EQ(without.subject.camera + without.subject.view, "");
  EXPECT_EQ(without.pixels, with.pixels);
  // As a reference: what a file says of its camera has to be one.
  EXPECT_FALSE(readReference(folder.path / "b.exr").camera);
  for (const char* broken : {"no JSON", R"({"position": 3})"}) {
    const fs::path file = writeLayers(folder.path / "c", size, layers, {broken, ""}).front();
    try {
      readReference(file);
      ADD_FAILURE() << broken;
    } catch (const InputError& error) {
      EXPECT_TRUE(contains(error.what(), "c.exr: iradCamera")) << error.what();
    }
  }
}

TEST(ImageIo, TheSamePixelsGiveTheSameFile) {
  test::TemporaryFolder folder;
  const glm::uvec2 size(64, 64);
  const std::vector<glm::vec4> pixels = ramp(size);
  const std::string first = slurp(writeLinear(folder.path / "a", size, pixels));
  sleep(1);  // a date in the file would now differ
  EXPECT_TRUE(slurp(writeLinear(folder.path / "a", size, pixels)) == first);
  EXPECT_GT(first.size(), 1000u);
}

TEST(ImageIo, AFullDiskIsAWorkErrorThatNamesTheFile) {
  test::TemporaryFolder folder;
  const glm::uvec2 size(256, 256);
  std::string exr, png;
  {
    FileSizeLimit limit(4096);
    exr = workError([&] { writeLinear(folder.path / "a", size, ramp(size)); });
    std::vector<glm::u8vec4> noise(65536);
    std::minstd_rand random;
    for (glm::u8vec4& pixel : noise) pixel = glm::u8vec4(random() >> 8, random() >> 8, random() >> 8, 0);
    png = workError([&] { writeDisplay(folder.path / "a", size, noise); });
  }
  EXPECT_TRUE(contains(exr, (folder.path / "a.exr").string())) << exr;
  EXPECT_TRUE(contains(png, (folder.path / "a.png").string())) << png;
  EXPECT_TRUE(listing(folder.path).empty());
}
#endif

}  // namespace
}  // namespace irad::output_suite
