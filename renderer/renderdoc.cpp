#include "renderer/renderdoc.h"

#include <dlfcn.h>
#include <renderdoc_app.h>

#include <string>

#include "renderer/base/error.h"
#include "renderer/base/output_file.h"

namespace irad {

struct RenderDocApi : RENDERDOC_API_1_1_2 {};

std::optional<RenderDoc> RenderDoc::find() {
  void* library = ::dlopen("librenderdoc.so", RTLD_NOW | RTLD_NOLOAD);
  if (!library) return std::nullopt;
  const auto getApi = reinterpret_cast<pRENDERDOC_GetAPI>(::dlsym(library, "RENDERDOC_GetAPI"));
  void* api = nullptr;
  if (!getApi || getApi(eRENDERDOC_API_Version_1_1_2, &api) != 1) return std::nullopt;
  const auto* table = static_cast<const RenderDocApi*>(api);
  table->SetCaptureKeys(nullptr, 0);
  return RenderDoc(*table);
}

std::filesystem::path RenderDoc::capture(const Device& device, const std::filesystem::path& stem,
                                         const std::function<void()>& work) const {
  void* const instance = RENDERDOC_DEVICEPOINTER_FROM_VKINSTANCE(device.instance);
  void* const anyWindow = nullptr;
  const auto end = [&]() -> std::filesystem::path {
    if (api_->EndFrameCapture(instance, anyWindow) != 1 || api_->GetNumCaptures() == 0)
      throw WorkError(fmt::format("RenderDoc made no capture {}", stem.string()));
    const uint32_t newest = api_->GetNumCaptures() - 1;
    uint32_t length = 0;  // with the terminating zero
    api_->GetCapture(newest, nullptr, &length, nullptr);
    std::string path(length, '\0');
    api_->GetCapture(newest, path.data(), &length, nullptr);
    return path.c_str();
  };
  api_->SetCaptureFilePathTemplate(stem.c_str());
  api_->StartFrameCapture(instance, anyWindow);
  try {
    work();
  } catch (...) {
    removeFile(end());  // DiscardFrameCapture of 1.24 crashes where nothing was presented
    throw;
  }
  return end();
}

}  // namespace irad
