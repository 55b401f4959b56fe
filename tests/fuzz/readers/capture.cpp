// The manifest of a capture or a recording, as the window lists it and takes it back.
#include "gi/captures.h"
#include "tests/fuzz/readers.h"

void irad::fuzz::capture(Bytes bytes) {
  readCapture(scratchFile("manifest.json", bytes), defaultSettings(/*cpuDevice=*/true));
}
