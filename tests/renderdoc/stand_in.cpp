// A stand-in for RenderDoc's library, for drivers that RenderDoc does not run on: what irad calls of its table. It
// captures nothing; its file holds the four letters that a capture begins with.
#include <renderdoc_app.h>

#include <cstring>
#include <fstream>
#include <string>

namespace {

std::string fileTemplate, captured;
bool capturing = false;

void setTemplate(const char* path) {
  fileTemplate = path;
}
void start(RENDERDOC_DevicePointer, RENDERDOC_WindowHandle) {
  capturing = true;
}
uint32_t end(RENDERDOC_DevicePointer, RENDERDOC_WindowHandle) {
  if (!capturing) return 0;
  capturing = false;
  captured = fileTemplate + "_capture.rdc";
  std::ofstream(captured) << "RDOC";
  return 1;
}
uint32_t count() {
  return captured.empty() ? 0 : 1;
}
uint32_t get(uint32_t index, char* path, uint32_t* length, uint64_t*) {
  if (index >= count()) return 0;
  if (path) std::memcpy(path, captured.c_str(), captured.size() + 1);
  *length = static_cast<uint32_t>(captured.size()) + 1;
  return 1;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) int RENDERDOC_GetAPI(RENDERDOC_Version, void** api) {
  static RENDERDOC_API_1_1_2 table{};
  table.SetCaptureKeys = [](RENDERDOC_InputButton*, int) {};
  table.SetCaptureFilePathTemplate = setTemplate;
  table.StartFrameCapture = start;
  table.EndFrameCapture = end;
  table.GetNumCaptures = count;
  table.GetCapture = get;
  *api = &table;
  return 1;
}
