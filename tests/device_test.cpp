// Choosing devices, poisoned memory, and the proof that the validation filter can fail.
#include <cmath>

#include "renderer/base/error.h"
#include "renderer/frame/frame.h"
#include "tests/support.h"

namespace irad::test::device_suite {
namespace {

TEST(DeviceChoice, ByIndexAndByPartOfTheName) {
  const std::vector<DeviceInfo> devices = Device::list();
  ASSERT_FALSE(devices.empty());
  for (const DeviceInfo& info : devices) {
    EXPECT_FALSE(info.name.empty());
    EXPECT_GT(info.memoryBytes, 0u);
    if (!info.missing.empty()) continue;
    EXPECT_EQ(Device::create({.select = std::to_string(info.index)})->info.name, info.name);
    std::string upper = info.name;
    for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    EXPECT_EQ(Device::create({.select = upper})->info.name, info.name);
  }
}

TEST(DeviceChoice, UnknownNamesListWhatThereIs) {
  for (const char* name : {"no such device", "99"}) try {
      Device::create({.select = name});
      FAIL() << name;
    } catch (const DeviceError& error) {
      EXPECT_EQ(error.exitStatus, 4);
      EXPECT_NE(std::string(error.what()).find(Device::list().front().name), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
}

TEST(DevicePoison, FreshMemoryIsNaN) {
  const auto device = Device::create({.validate = true, .poison = true});
  ShaderLibrary shaders;
  Timings timings;
  {
    Context context(*device, shaders, timings);
    const Buffer buffer(*device, "poisoned", Subsystem::Staging, 4 * 1001);
    for (const float v : downloadAs<float>(context, buffer)) ASSERT_TRUE(std::isnan(v));
    const Buffer mapped(*device, "poisoned mapped", Subsystem::Staging, 64, Access::Upload);
    for (int i = 0; i < 16; ++i) ASSERT_TRUE(std::isnan(static_cast<const float*>(mapped.mapped)[i]));
    const Image image(*device, {.name = "poisoned image", .format = VK_FORMAT_R32_SFLOAT, .width = 5, .height = 3});
    const std::vector<std::byte> bytes = download(context, image);
    for (size_t i = 0; i < bytes.size(); i += 4) {
      float v;
      std::memcpy(&v, bytes.data() + i, 4);
      ASSERT_TRUE(std::isnan(v));
    }
    const Image ids(*device, {.name = "poisoned ids", .format = VK_FORMAT_R32_UINT, .width = 5, .height = 3});
    for (const std::byte b : download(context, ids)) ASSERT_EQ(b, std::byte{0xFF});
    const Image depth(*device, {.name = "poisoned depth", .format = VK_FORMAT_D32_SFLOAT, .width = 5, .height = 3});
    for (const std::byte b : download(context, depth)) ASSERT_EQ(b, std::byte{0});
  }
  for (const std::string& message : device->validationMessages()) ADD_FAILURE() << message;
}

TEST(DeviceValidation, AMistakeIsCounted) {
  const auto device = Device::create({.validate = true});
  EXPECT_EQ(device->validationMessages().size(), 0u);
  const VkBufferCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = 0, .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT};
  VkBuffer buffer = VK_NULL_HANDLE;
  if (vkCreateBuffer(device->handle, &info, nullptr, &buffer) == VK_SUCCESS)
    vkDestroyBuffer(device->handle, buffer, nullptr);
  ASSERT_FALSE(device->validationMessages().empty());
  EXPECT_NE(device->validationMessages().front().find("VUID-VkBufferCreateInfo-size"), std::string::npos);
}

TEST(DeviceValidation, AMissingBarrierIsCounted) {
  const auto device = Device::create({.validate = true});
  ShaderLibrary shaders;
  Timings timings;
  {
    Context context(*device, shaders, timings);
    const Buffer buffer(*device, "raced", Subsystem::Staging, 64);
    Frame frame = context.begin();
    frame.pass("Race").record([&](VkCommandBuffer commands) {  // declares nothing
      vkCmdFillBuffer(commands, buffer.handle, 0, 64, 1);
      vkCmdFillBuffer(commands, buffer.handle, 0, 64, 2);
    });
    frame.submitAndWait();
  }
  ASSERT_EQ(device->validationMessages().size(), 1u);
  EXPECT_NE(device->validationMessages().front().find("SYNC-HAZARD-WRITE"), std::string::npos);
}

TEST(DeviceTeardown, IsSilent) {
  // Resources dropped with work in flight, a frame dropped unsubmitted, a readback never noticed.
  std::vector<std::string> messages;
  bool delivered = false;
  {
    const auto device = Device::create({.validate = true});
    ShaderLibrary shaders;
    Timings timings;
    {
      Context context(*device, shaders, timings);
      Frame open = context.begin();
      {
        const Buffer a(*device, "a", Subsystem::Staging, 1 << 20);
        const Image b(
            *device, {.name = "b", .format = VK_FORMAT_R8_UNORM, .width = 16, .height = 16, .layers = 6, .cube = true});
        open.pass("Fill").fill(a, 1);
        open.pass("Clear").clear(b, ClearColor{});
        open.readback(a, 0, 16, [&](auto) { delivered = true; });
      }
      open.submit();
      Frame dropped = context.begin();
      const Buffer c(*device, "c", Subsystem::Staging, 1 << 20);
      dropped.pass("Fill").fill(c, 1);
    }
    EXPECT_TRUE(delivered);
    device->waitIdle();
    EXPECT_EQ(device->memory().used(), 0u);
    messages = device->validationMessages();
  }
  for (const std::string& message : messages) ADD_FAILURE() << message;
}

}  // namespace
}  // namespace irad::test::device_suite
