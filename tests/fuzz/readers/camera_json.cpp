// A camera of the command line as JSON, and that it survives being written to a manifest and read again.
#include "renderer/scene/camera_json.h"

#include "tests/fuzz/readers.h"

void irad::fuzz::camera_json(Bytes bytes) {
  const Camera camera = cameraFromJson({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  const std::string text = cameraToJson(camera);
  if (cameraToJson(cameraFromJson(text)) != text) throw Unsound("a camera changes when written and read: " + text);
}
