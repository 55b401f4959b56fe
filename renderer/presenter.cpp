#include "renderer/presenter.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>

#include "renderer/base/console.h"
#include "renderer/base/error.h"
#include "renderer/vulkan_check.h"

namespace irad {
namespace {

std::string glfwMessage() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text ? text : "no reason given";
}

/// GLFW is one per process; so is the window.
struct GlfwProcess {
  GlfwProcess() {
    if (!glfwInit()) throw DeviceError(fmt::format("no window: {}", glfwMessage()));
  }
  ~GlfwProcess() { glfwTerminate(); }
  GlfwProcess(const GlfwProcess&) = delete;
};

VkImageMemoryBarrier2 transition(VkImage image, VkImageLayout from, VkImageLayout to, Use before, Use after) {
  return {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
          .srcStageMask = before.stages,
          .srcAccessMask = before.access,
          .dstStageMask = after.stages,
          .dstAccessMask = after.access,
          .oldLayout = from,
          .newLayout = to,
          .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
          .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
          .image = image,
          .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
}

void record(VkCommandBuffer commands, const VkImageMemoryBarrier2& barrier) {
  const VkDependencyInfo info{
      .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &barrier};
  vkCmdPipelineBarrier2(commands, &info);
}

}  // namespace

struct Presenter::Impl {
  GlfwProcess glfw;
  GLFWwindow* window = nullptr;
  Context* context = nullptr;
  VkSurfaceKHR surface = VK_NULL_HANDLE;
  VkSwapchainKHR swapchain = VK_NULL_HANDLE;
  VkExtent2D extent{};
  std::vector<VkImage> images;
  std::vector<VkSemaphore> rendered;  ///< one per image: presentation waits for it
  /// Acquire semaphores whose last wait has finished; shared with the retirements that return them.
  std::shared_ptr<std::vector<VkSemaphore>> idle = std::make_shared<std::vector<VkSemaphore>>();
  VkSemaphore acquired = VK_NULL_HANDLE;  ///< of the image at hand; null: none at hand
  uint32_t image = 0;
  bool outdated = false, surfaceLost = false;
  uint32_t rebuilds = 0;

  ~Impl() {
    if (window) glfwDestroyWindow(window);
  }
  const Device& device() const { return context->device; }
  glm::uvec2 size() const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window, &width, &height);
    return {static_cast<uint32_t>(std::max(width, 0)), static_cast<uint32_t>(std::max(height, 0))};
  }

  VkSemaphore makeSemaphore() const {
    const VkSemaphoreCreateInfo info{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    VkSemaphore semaphore = VK_NULL_HANDLE;
    vkCheck(vkCreateSemaphore(device().handle, &info, nullptr, &semaphore), "creating a semaphore");
    return semaphore;
  }
  void makeSurface() {
    const VkResult result = glfwCreateWindowSurface(device().instance, window, nullptr, &surface);
    if (result != VK_SUCCESS) throw DeviceError(fmt::format("no surface for the window: {}", glfwMessage()));
    VkBool32 supported = VK_FALSE;
    vkCheck(vkGetPhysicalDeviceSurfaceSupportKHR(device().physical, device().queueFamily, surface, &supported),
            "asking whether the device can present");
    if (!supported) throw DeviceError(fmt::format("{} cannot present to this display", device().info.name));
  }
  VkSurfaceFormatKHR chooseFormat() const;
  bool rebuild();
  void drop();
};

VkSurfaceFormatKHR Presenter::Impl::chooseFormat() const {
  uint32_t count = 0;
  vkGetPhysicalDeviceSurfaceFormatsKHR(device().physical, surface, &count, nullptr);
  std::vector<VkSurfaceFormatKHR> formats(count);
  vkCheck(vkGetPhysicalDeviceSurfaceFormatsKHR(device().physical, surface, &count, formats.data()),
          "listing the surface's formats");
  // UNORM: the image is encoded for the display already; an sRGB format would encode it twice.
  for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_A2B10G10R10_UNORM_PACK32,
                                VK_FORMAT_A2R10G10B10_UNORM_PACK32})
    for (const VkSurfaceFormatKHR& format : formats)
      if (format.format == wanted && format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) return format;
  throw DeviceError(fmt::format("{}: none of the window's {} formats is a plain 8 or 10 bit one", device().info.name,
                                formats.size()));
}

/// False while nothing can be shown: the window has no area, or its surface was lost again.
bool Presenter::Impl::rebuild() {
  device().waitIdle();
  if (surfaceLost) {
    drop();
    vkDestroySurfaceKHR(device().instance, surface, nullptr);
    surface = VK_NULL_HANDLE;
    makeSurface();
  }
  VkSurfaceCapabilitiesKHR can;
  const VkResult asked = vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device().physical, surface, &can);
  surfaceLost = asked == VK_ERROR_SURFACE_LOST_KHR;
  if (surfaceLost) return false;
  vkCheck(asked, "asking for the surface's size");
  const glm::uvec2 wanted = size();
  extent = can.currentExtent;
  if (extent.width == UINT32_MAX)  // the surface takes the swapchain's size
    extent = {std::clamp(wanted.x, can.minImageExtent.width, can.maxImageExtent.width),
              std::clamp(wanted.y, can.minImageExtent.height, can.maxImageExtent.height)};
  if (extent.width == 0 || extent.height == 0 || wanted.x == 0 || wanted.y == 0) return false;
  if (!(can.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_DST_BIT))
    throw DeviceError(fmt::format("{}: the window's images cannot be copied to", device().info.name));

  const VkSurfaceFormatKHR format = chooseFormat();
  const uint32_t most = can.maxImageCount == 0 ? UINT32_MAX : can.maxImageCount;
  const VkCompositeAlphaFlagBitsKHR alpha = can.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                                                ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                                                : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
  const VkSwapchainCreateInfoKHR info{.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
                                      .surface = surface,
                                      .minImageCount = std::min(can.minImageCount + 1, most),
                                      .imageFormat = format.format,
                                      .imageColorSpace = format.colorSpace,
                                      .imageExtent = extent,
                                      .imageArrayLayers = 1,
                                      .imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                      .imageSharingMode = VK_SHARING_MODE_EXCLUSIVE,
                                      .preTransform = can.currentTransform,
                                      .compositeAlpha = alpha,
                                      .presentMode = VK_PRESENT_MODE_FIFO_KHR,
                                      .clipped = VK_TRUE,
                                      .oldSwapchain = swapchain};
  VkSwapchainKHR made = VK_NULL_HANDLE;
  vkCheck(vkCreateSwapchainKHR(device().handle, &info, nullptr, &made), "creating the swapchain");
  drop();
  swapchain = made;
  uint32_t count = 0;
  vkCheck(vkGetSwapchainImagesKHR(device().handle, swapchain, &count, nullptr), "listing the swapchain's images");
  images.resize(count);
  vkCheck(vkGetSwapchainImagesKHR(device().handle, swapchain, &count, images.data()), "listing the swapchain's images");
  for (uint32_t i = 0; i < count; ++i) {
    device().name(VK_OBJECT_TYPE_IMAGE, reinterpret_cast<uint64_t>(images[i]), fmt::format("swapchain {}", i));
    rendered.push_back(makeSemaphore());
  }
  outdated = false;
  ++rebuilds;
  return true;
}

/// The swapchain and what belongs to it; the device is idle.
void Presenter::Impl::drop() {
  if (acquired) {
    // Signalled, or about to be, and never waited for: it cannot be used again.
    vkDestroySemaphore(device().handle, acquired, nullptr);
    acquired = VK_NULL_HANDLE;
  }
  for (const VkSemaphore semaphore : rendered) vkDestroySemaphore(device().handle, semaphore, nullptr);
  rendered.clear();
  images.clear();
  if (swapchain) vkDestroySwapchainKHR(device().handle, swapchain, nullptr);
  swapchain = VK_NULL_HANDLE;
}

Presenter::Presenter(const std::string& title, int width, int height) : impl_(std::make_unique<Impl>()) {
  if (!glfwVulkanSupported()) throw DeviceError(fmt::format("no window: {}", glfwMessage()));
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  impl_->window = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  if (!impl_->window) throw DeviceError(fmt::format("no window: {}", glfwMessage()));
}

Presenter::~Presenter() {
  try {
    detach();
  } catch (const Error& error) {
    tell("irad: closing the window: {}\n", error.what());
  }
}

void Presenter::attach(Context& context) {
  IRAD_CHECK(context.device.options.presentable, "the device was not created presentable");
  IRAD_CHECK(!impl_->context, "the presenter is attached already");
  impl_->context = &context;
  impl_->makeSurface();
  impl_->outdated = true;  // the first acquire makes the swapchain
}

void Presenter::detach() {
  if (!impl_->context) return;
  impl_->device().settle();
  impl_->drop();
  for (const VkSemaphore semaphore : *impl_->idle) vkDestroySemaphore(impl_->device().handle, semaphore, nullptr);
  impl_->idle->clear();
  if (impl_->surface) vkDestroySurfaceKHR(impl_->device().instance, impl_->surface, nullptr);
  impl_->surface = VK_NULL_HANDLE;
  impl_->context = nullptr;
}

bool Presenter::poll(double waitSeconds) {
  if (waitSeconds > 0)
    glfwWaitEventsTimeout(waitSeconds);
  else
    glfwPollEvents();
  return !glfwWindowShouldClose(impl_->window);
}

bool Presenter::acquire() {
  Impl& p = *impl_;
  IRAD_CHECK(p.context, "the presenter is not attached");
  const glm::uvec2 size = p.size();
  if (size.x == 0 || size.y == 0) return false;
  if (p.acquired) {  // the last one was not presented
    if (p.extent.width == size.x && p.extent.height == size.y) return true;
    p.outdated = true;
  }
  for (int attempt = 0; attempt < 4; ++attempt) {
    if ((p.outdated || p.surfaceLost || !p.swapchain) && !p.rebuild()) return false;
    VkSemaphore semaphore = VK_NULL_HANDLE;
    if (p.idle->empty()) {
      semaphore = p.makeSemaphore();
    } else {
      semaphore = p.idle->back();
      p.idle->pop_back();
    }
    const VkResult result =
        vkAcquireNextImageKHR(p.device().handle, p.swapchain, UINT64_MAX, semaphore, VK_NULL_HANDLE, &p.image);
    if (result == VK_SUCCESS || result == VK_SUBOPTIMAL_KHR) {
      p.acquired = semaphore;
      p.outdated = result == VK_SUBOPTIMAL_KHR || p.extent.width != size.x || p.extent.height != size.y;
      return true;
    }
    p.idle->push_back(semaphore);  // untouched by the failed acquire
    if (result == VK_ERROR_OUT_OF_DATE_KHR)
      p.outdated = true;
    else if (result == VK_ERROR_SURFACE_LOST_KHR)
      p.surfaceLost = true;
    else
      vkCheck(result, "acquiring a swapchain image");
  }
  return false;  // the window changes faster than we follow: try again with the next frame
}

void Presenter::present(Frame& frame, const Image& source) {
  Impl& p = *impl_;
  IRAD_CHECK(p.acquired, "present without acquire");
  const VkImage target = p.images[p.image];
  const bool scaled = source.desc.width != p.extent.width || source.desc.height != p.extent.height;
  constexpr Use kBlitWrite{VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
  frame.pass("Present")
      .declare(source, {VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_READ_BIT})
      .record([&](VkCommandBuffer commands) {
        // The submission waits for the acquisition at all stages; the transition comes after that.
        record(commands, transition(target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                    {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, 0}, kBlitWrite));
        const VkImageBlit region{
            .srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
            .srcOffsets = {{}, {static_cast<int32_t>(source.desc.width), static_cast<int32_t>(source.desc.height), 1}},
            .dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
            .dstOffsets = {{}, {static_cast<int32_t>(p.extent.width), static_cast<int32_t>(p.extent.height), 1}}};
        vkCmdBlitImage(commands, source.handle, VK_IMAGE_LAYOUT_GENERAL, target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                       1, &region, scaled ? VK_FILTER_LINEAR : VK_FILTER_NEAREST);
        record(commands, transition(target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR,
                                    kBlitWrite, {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, 0}));
      });
  frame.submit(p.acquired, p.rendered[p.image]);
  p.device().retire([idle = p.idle, semaphore = p.acquired] { idle->push_back(semaphore); });
  p.acquired = VK_NULL_HANDLE;

  const VkPresentInfoKHR info{.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                              .waitSemaphoreCount = 1,
                              .pWaitSemaphores = &p.rendered[p.image],
                              .swapchainCount = 1,
                              .pSwapchains = &p.swapchain,
                              .pImageIndices = &p.image};
  const VkResult result = vkQueuePresentKHR(p.device().queue, &info);
  if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR)
    p.outdated = true;
  else if (result == VK_ERROR_SURFACE_LOST_KHR)
    p.surfaceLost = true;
  else
    vkCheck(result, "presenting");
}

GLFWwindow* Presenter::window() const {
  return impl_->window;
}
glm::uvec2 Presenter::framebufferSize() const {
  return impl_->size();
}
void Presenter::resize(int width, int height) {
  glfwSetWindowSize(impl_->window, width, height);
}
uint32_t Presenter::rebuilds() const {
  return impl_->rebuilds;
}

}  // namespace irad
