// Captures under RenderDoc, by its layer. It wants bufferDeviceAddressCaptureReplay of a Vulkan 1.3 device, which
// Mesa's CPU driver does not have in Debian 12: skipped there, in words.
#include <gtest/gtest.h>

#if IRAD_UI

#include "renderer/base/error.h"
#include "renderer/renderdoc.h"
#include "tests/support.h"

namespace irad::renderdoc_suite {
namespace {

TEST(RenderDoc, CapturesWhatIsSubmittedAndNothingOfWhatFails) {
  setenv("ENABLE_VULKAN_RENDERDOC_CAPTURE", "1", /*overwrite=*/1);  // the loader reads it when the instance is made
  std::unique_ptr<Device> device;
  try {
    device = Device::create({});
  } catch (const DeviceError& error) {
    GTEST_SKIP() << "under RenderDoc: " << error.what();
  }
  const std::optional<RenderDoc> renderDoc = RenderDoc::find();
  if (!renderDoc) GTEST_SKIP() << "RenderDoc's layer is not installed";
  ShaderLibrary shaders;
  Timings timings;
  Context context(*device, shaders, timings);
  const TemporaryFolder folder;
  const Buffer buffer(*device, "buffer", Subsystem::Staging, 4096);
  const auto work = [&] {
    Frame frame = context.begin();
    frame.pass("GI Solve").fill(buffer, 7);
    frame.submitAndWait();
  };
  EXPECT_THROW(renderDoc->capture(*device, folder.path / "box", [] { throw WorkError("lost"); }), WorkError);
  EXPECT_TRUE(test::contents(folder.path).empty()) << "a capture of work that failed";
  const std::filesystem::path first = renderDoc->capture(*device, folder.path / "box", work);
  const std::filesystem::path second = renderDoc->capture(*device, folder.path / "box", work);
  EXPECT_NE(first, second);
  for (const std::filesystem::path& file : {first, second}) {
    EXPECT_EQ(file.parent_path(), folder.path);
    EXPECT_TRUE(file.filename().string().starts_with("box")) << file;
    EXPECT_EQ(test::slurp(file).substr(0, 4), "RDOC") << file;
  }
}

}  // namespace
}  // namespace irad::renderdoc_suite

#else

TEST(RenderDoc, NotBuilt) {
  GTEST_SKIP() << "built without IRAD_UI";
}

#endif
