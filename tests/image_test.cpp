// Images and raster passes on the device at hand: clears, sampling, aliases, mips, triangles, depth layers.
#include <algorithm>
#include <numeric>

#include "renderer/base/error.h"
#include "renderer/frame/frame.h"
#include "tests/test_shaders.h"

namespace irad::test::image_suite {
namespace {

template <class T>
std::vector<T> texels(Context& context, const Image& image) {
  const std::vector<std::byte> bytes = download(context, image);
  std::vector<T> out(bytes.size() / sizeof(T));
  std::memcpy(out.data(), bytes.data(), bytes.size());
  return out;
}

class Images : public GpuTest {
 protected:
  const Device& device() { return context().device; }
};

TEST_F(Images, RoundTripOfEveryShape) {
  const ImageDesc shapes[] = {
      {.name = "2D", .format = VK_FORMAT_R8G8B8A8_UNORM, .width = 37, .height = 21},
      {.name = "3D", .format = VK_FORMAT_R16G16B16A16_SFLOAT, .width = 9, .height = 8, .depth = 7},
      {.name = "flat 3D", .format = VK_FORMAT_R32_UINT, .width = 5, .height = 4, .volume = true},
      {.name = "array", .format = VK_FORMAT_R8_UINT, .width = 12, .height = 5, .layers = 3},
      {.name = "cube", .format = VK_FORMAT_R32_SFLOAT, .width = 4, .height = 4, .layers = 12, .cube = true},
      {.name = "sRGB", .format = VK_FORMAT_R8G8B8A8_SRGB, .width = 6, .height = 6, .mips = 3}};
  for (const ImageDesc& desc : shapes) {
    const Image image(device(), desc);
    std::vector<std::byte> in(download(context(), image).size());
    // 16-bit floats: keep clear of NaN patterns, which a copy need not preserve on every device.
    for (size_t i = 0; i < in.size(); ++i) in[i] = static_cast<std::byte>(i * 37 % 111);
    upload(context(), image, in);
    EXPECT_TRUE(download(context(), image) == in) << desc.name;
  }
}

TEST_F(Images, LargerThanAChunk) {
  // 96 MiB: 256 slices of 384 KiB each cross the 64 MiB pieces.
  const Image image(device(),
                    {.name = "large", .format = VK_FORMAT_R32_UINT, .width = 384, .height = 256, .depth = 256});
  std::vector<uint32_t> in(384u * 256 * 256);
  std::iota(in.begin(), in.end(), 17u);
  upload(context(), image, std::as_bytes(std::span(in)));
  EXPECT_TRUE(texels<uint32_t>(context(), image) == in);
}

TEST_F(Images, ClearsAndCopies) {
  const Image image(device(), {.name = "cleared", .format = VK_FORMAT_R32G32B32A32_SFLOAT, .width = 3, .height = 2});
  const Image other(device(), {.name = "copied", .format = VK_FORMAT_R32G32B32A32_SFLOAT, .width = 3, .height = 2});
  const Buffer buffer(device(), "between", Subsystem::Staging, 3 * 2 * 16);
  Frame frame = context().begin();
  frame.pass("Clear").clear(image, ClearColor{1, 2, 3, 4});
  frame.pass("Copy").copy(image, buffer);
  frame.pass("Copy").copy(buffer, other);
  frame.pass("Clear").clear(image, ClearColor{});
  frame.submitAndWait();
  std::vector<float> expected;
  for (int i = 0; i < 6; ++i) expected.insert(expected.end(), {1, 2, 3, 4});
  EXPECT_EQ(texels<float>(context(), other), expected);
  EXPECT_EQ(texels<float>(context(), image), std::vector<float>(24, 0.0f));
}

TEST_F(Images, SampleAndStore) {
  const Image source(device(), {.name = "source", .format = VK_FORMAT_R32_SFLOAT, .width = 16, .height = 16});
  const Image target(device(), {.name = "target", .format = VK_FORMAT_R32_SFLOAT, .width = 16, .height = 16});
  std::vector<float> in(256);
  std::iota(in.begin(), in.end(), -5.0f);
  upload(context(), source, std::as_bytes(std::span(in)));
  Frame frame = context().begin();
  frame.pass("Image")
      .shader(shader("image.comp"))
      .write(target)
      .sample(source, sampler(device(), {}))
      .push(0)
      .dispatch(glm::uvec2(16));
  frame.submitAndWait();
  for (float& v : in) v *= 2;
  EXPECT_EQ(texels<float>(context(), target), in);
}

TEST_F(Images, AliasSharesTheTexels) {
  const Image image(device(), {.name = "alias",
                               .format = VK_FORMAT_R8G8B8A8_UNORM,
                               .width = 8,
                               .height = 1,
                               .aliasFormat = VK_FORMAT_R32_UINT});
  Frame frame = context().begin();
  frame.pass("Alias").shader(shader("alias.comp")).writeAlias(image).dispatch(8);
  frame.submitAndWait();
  const std::vector<uint8_t> bytes = texels<uint8_t>(context(), image);
  for (uint8_t x = 0; x < 8; ++x) {
    EXPECT_EQ(bytes[4 * x + 0], 1);
    EXPECT_EQ(bytes[4 * x + 1], 2);
    EXPECT_EQ(bytes[4 * x + 2], 3);
    EXPECT_EQ(bytes[4 * x + 3], 4 + x);
  }
}

TEST_F(Images, EveryLevelIsUploaded) {
  const Image source(device(),
                     {.name = "mips", .format = VK_FORMAT_R8G8B8A8_UNORM, .width = 5, .height = 4, .mips = 3});
  const std::vector<std::vector<uint8_t>> levels{std::vector<uint8_t>(20, 90), {8, 16, 24, 32}, {20}};
  for (uint32_t mip = 0; mip < levels.size(); ++mip) {
    std::vector<glm::u8vec4> in;
    for (const uint8_t value : levels[mip]) in.emplace_back(value);
    upload(context(), source, std::as_bytes(std::span(in)), mip);
  }
  for (const int lod : {1, 2}) {
    const std::vector<uint8_t>& expected = levels[lod];
    const auto size = static_cast<uint32_t>(3 - lod);
    const Image target(device(), {.name = "level", .format = VK_FORMAT_R32_SFLOAT, .width = size, .height = size});
    Frame frame = context().begin();
    frame.pass("Image")
        .shader(shader("image.comp"))
        .write(target)
        .sample(source, sampler(device(), {}))
        .push(lod)
        .dispatch(glm::uvec2(size));
    frame.submitAndWait();
    const std::vector<float> level = texels<float>(context(), target);
    for (size_t i = 0; i < expected.size(); ++i) EXPECT_FLOAT_EQ(level[i] * 255 / 2, expected[i]);
  }
}

// A right triangle in the lower left corner of 64x64 pixels whose legs are 32.5 pixels: 32 + 31 + ... + 1 = 528
// centres.
constexpr float kEnd = 32.5f / 32 - 1;
std::vector<glm::vec4> corner(float z, bool clockwise = false) {
  std::vector<glm::vec4> v{{-1, -1, z, 1}, {kEnd, -1, z, 1}, {-1, kEnd, z, 1}};
  if (clockwise) std::swap(v[1], v[2]);
  return v;
}
constexpr VkImageUsageFlags kColor =
    VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;

TEST_F(Images, TriangleCoversItsPixelCentres) {
  const Image target(
      device(), {.name = "colour", .format = VK_FORMAT_R8G8B8A8_UNORM, .width = 64, .height = 64, .usage = kColor});
  for (const auto& [clockwise, cull, expected] : {std::tuple{false, VK_CULL_MODE_NONE, 528},
                                                  {true, VK_CULL_MODE_NONE, 528},
                                                  {false, VK_CULL_MODE_BACK_BIT, 528},
                                                  {true, VK_CULL_MODE_BACK_BIT, 0},
                                                  {false, VK_CULL_MODE_FRONT_BIT, 0}}) {
    const std::vector<glm::vec4> vertices = corner(0.5f, clockwise);
    const Buffer buffer = makeBuffer<glm::vec4>(context(), "vertices", Subsystem::Scene, vertices);
    const auto mode = static_cast<VkCullModeFlags>(cull);
    Frame frame = context().begin();
    Pass pass = frame.pass("Raster");
    pass.shaders({shader("triangle.vert"), shader("white.frag")})
        .color(target, ClearColor{0, 0, 0, 0})
        .push(pass.in(buffer))
        .run([&](Commands& commands) {
          commands.cull(mode);
          commands.draw(3);
        });
    frame.submitAndWait();
    const std::vector<uint32_t> pixels = texels<uint32_t>(context(), target);
    EXPECT_EQ(std::count(pixels.begin(), pixels.end(), 0xFFFFFFFFu), expected) << clockwise << " " << cull;
    EXPECT_EQ(std::count(pixels.begin(), pixels.end(), 0u), 64 * 64 - expected);
    // y is up: the corner is in the last row of the image.
    EXPECT_EQ(pixels[63 * 64], expected ? 0xFFFFFFFFu : 0u);
  }
}

TEST_F(Images, LoadKeepsAndBlendAdds) {
  const Image target(
      device(), {.name = "sum", .format = VK_FORMAT_R32G32B32A32_SFLOAT, .width = 64, .height = 64, .usage = kColor});
  const Buffer buffer = makeBuffer<glm::vec4>(context(), "vertices", Subsystem::Scene, corner(0.5f));
  Frame frame = context().begin();
  for (int i = 0; i < 3; ++i) {
    Pass pass = frame.pass("Raster");
    pass.shaders({shader("triangle.vert"), shader("white.frag")})
        .color(target, i == 0 ? std::optional(ClearColor{10, 0, 0, 0}) : std::nullopt)
        .additive()
        .push(pass.in(buffer))
        .draw(3);
  }
  frame.submitAndWait();
  const std::vector<float> pixels = texels<float>(context(), target);
  EXPECT_FLOAT_EQ(pixels[4 * 63 * 64], 13.0f);
  EXPECT_FLOAT_EQ(pixels[0], 10.0f);
}

TEST_F(Images, DepthLayersAndReadOnlyDepth) {
  const Image depth(device(),
                    {.name = "depth layers", .format = VK_FORMAT_D32_SFLOAT, .width = 64, .height = 64, .layers = 3});
  const Image target(
      device(), {.name = "colour", .format = VK_FORMAT_R8G8B8A8_UNORM, .width = 64, .height = 64, .usage = kColor});
  const Buffer near = makeBuffer<glm::vec4>(context(), "near", Subsystem::Scene, corner(0.25f));
  const Buffer far = makeBuffer<glm::vec4>(context(), "far", Subsystem::Scene, corner(0.75f));
  Frame frame = context().begin();
  frame.pass("Clear").clear(depth, ClearColor{1, 0, 0, 0});
  const auto draw = [&](const Buffer& triangle, int layer) {
    Pass pass = frame.pass("Depth");
    pass.shader(shader("triangle.vert")).depth(depth, true, 1.0f, layer).push(pass.in(triangle)).draw(3);
  };
  draw(near, 0);
  draw(far, 2);
  // Against layer 0 (0.25) the far triangle is hidden; an equal one passes EQUAL.
  Pass test = frame.pass("Test");
  test.shaders({shader("triangle.vert"), shader("white.frag")})
      .color(target, ClearColor{})
      .depth(depth, false)
      .push(test.in(far))
      .draw(3);
  frame.submitAndWait();
  std::vector<uint32_t> pixels = texels<uint32_t>(context(), target);
  EXPECT_EQ(std::count(pixels.begin(), pixels.end(), 0xFFFFFFFFu), 0);
  Frame second = context().begin();
  Pass equal = second.pass("Test");
  equal.shaders({shader("triangle.vert"), shader("white.frag")})
      .color(target, ClearColor{})
      .depth(depth, false)
      .depthCompare(VK_COMPARE_OP_EQUAL)
      .push(equal.in(near))
      .draw(3);
  second.submitAndWait();
  pixels = texels<uint32_t>(context(), target);
  EXPECT_EQ(std::count(pixels.begin(), pixels.end(), 0xFFFFFFFFu), 528);

  const std::vector<float> d = texels<float>(context(), depth);
  ASSERT_EQ(d.size(), 3u * 4096);
  EXPECT_EQ(std::count(d.begin(), d.begin() + 4096, 0.25f), 528);
  EXPECT_EQ(std::count(d.begin(), d.begin() + 4096, 1.0f), 4096 - 528);
  EXPECT_EQ(std::count(d.begin() + 4096, d.begin() + 8192, 1.0f), 4096);
  EXPECT_EQ(std::count(d.begin() + 8192, d.end(), 0.75f), 528);
}

TEST_F(Images, ThrowingBodyClosesItsPass) {
  const Image target(
      device(), {.name = "colour", .format = VK_FORMAT_R8G8B8A8_UNORM, .width = 64, .height = 64, .usage = kColor});
  Frame frame = context().begin();
  EXPECT_THROW(frame.pass("Raster")
                   .shaders({shader("triangle.vert"), shader("white.frag")})
                   .color(target, ClearColor{1, 1, 1, 1})
                   .run([](Commands&) { throw WorkError("stop"); }),
               WorkError);
  frame.submitAndWait();
  EXPECT_EQ(texels<uint32_t>(context(), target), std::vector<uint32_t>(4096, 0xFFFFFFFFu));
}

}  // namespace
}  // namespace irad::test::image_suite
