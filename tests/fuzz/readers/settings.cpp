// Settings as JSON, and that what was accepted is a fixed point: written and read again it is the same.
#include "gi/settings.h"

#include "tests/fuzz/readers.h"

void irad::fuzz::settings(Bytes bytes) {
  Settings settings, again;
  settingsFromJson(settings, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  const std::string text = settingsToJson(settings);
  settingsFromJson(again, text);
  if (settingsToJson(again) != text) throw Unsound("settings change when written and read: " + text);
}
